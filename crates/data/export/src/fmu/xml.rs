//! XML elements that both versions have.

use super::variables::{FmuVariable, UNITS};
use crate::export_plan::ExportPlan;
use crate::header;
use crate::quoting::single_line;

/// Text escaped for an attribute or content, on one line.
pub fn escape_xml(text: &str) -> String {
    // The ampersand first, as the other replacements contain it.
    let marked = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    single_line(&marked.replace('"', "&quot;"))
}

/// Elements of the units, with their base units; `space` is the prefix of their namespace.
pub fn unit_elements(space: &str) -> String {
    let unit = |(name, exponents): (&str, [i32; 4])| {
        let of = ["kg", "m", "s", "rad"].into_iter().zip(exponents);
        let of: String =
            of.filter(|(_, n)| *n != 0).map(|(base, n)| format!(" {base}=\"{n}\"")).collect();
        format!("    <{space}Unit name=\"{name}\"><{space}BaseUnit{of}/></{space}Unit>\n")
    };
    UNITS.into_iter().map(unit).collect()
}

/// Unit, range and start value of a variable as attributes.
pub fn variable_attributes(variable: &FmuVariable) -> String {
    let [low, high] = variable.range;
    let numbers = [("min", low), ("max", high), ("start", variable.start)];
    let unit = variable.unit.iter().map(|unit| format!(" unit=\"{unit}\""));
    let numbers = numbers
        .into_iter()
        .filter_map(|(name, value)| value.map(|value| format!(" {name}=\"{value:?}\"")));
    unit.chain(numbers).collect()
}

/// Summary of the model in one line.
pub fn model_summary(plan: &ExportPlan) -> String {
    escape_xml(&plan.provenance.iter().take(4).cloned().collect::<Vec<_>>().join(". "))
}

/// HTML page with the header of the export.
pub fn documentation_page(plan: &ExportPlan) -> String {
    let lines: String =
        header::header_lines(plan).iter().map(|line| escape_xml(line) + "\n").collect();
    let name = escape_xml(&plan.name);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta \
         charset=\"utf-8\"><title>{name}</title></head>\n<body><h1>{name}</h1>\n<pre>\n{lines}</pre></body></html>\n"
    )
}
