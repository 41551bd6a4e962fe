//! Export as a Modelica model.

use sistership_formula::Function;

use crate::coefficients::ExportCoefficient;
use crate::error::ExportError;
use crate::export_plan::ExportPlan;
use crate::expression::{TargetLanguage, function_name};
use crate::external_input::ExternalInput;
use crate::format::ModelFormat;
use crate::quoting::escape_modelica;
use crate::states::STATES;
use crate::{header, line_wrapping, range, rates};

/// Model file for Modelica 3.4, without any library.
#[derive(Debug)]
pub struct ModelicaFormat;

impl ModelFormat for ModelicaFormat {
    fn name(&self) -> &'static str {
        "modelica"
    }

    fn extension(&self) -> &'static str {
        "mo"
    }

    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError> {
        Ok(source_text(plan).into_bytes())
    }
}

/// Depth of deep water, m, as Modelica has no infinity.
const DEEP_M: f64 = 1e9;

impl TargetLanguage for ModelicaFormat {
    fn number_literal(&self, value: f64) -> String {
        // Infinity becomes the largest double.
        let value = value.clamp(-f64::MAX, f64::MAX);
        if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") }
    }

    fn state_name(&self, place: usize) -> String {
        STATES[place].0.to_owned()
    }

    fn input_name(&self, outside: &ExternalInput) -> String {
        outside.identifier.clone()
    }

    fn coefficient_name(&self, coefficient: &ExportCoefficient) -> String {
        coefficient.identifier.clone()
    }

    fn write_power(&self, a: &str, b: &str) -> String {
        format!("{a}^{b}")
    }

    /// Call of a function. Minimum, maximum and sign are written as conditional expressions, which
    /// every tool supports.
    fn write_call(&self, of: Function, arguments: &[&str]) -> String {
        match (of, arguments) {
            (Function::Sign, [a]) => {
                format!("if {a} > 0.0 then 1.0 elseif {a} < 0.0 then -1.0 else 0.0")
            }
            (Function::Min, [a, b]) => self.write_conditional("<", [a, b, a, b]),
            (Function::Max, [a, b]) => self.write_conditional(">", [a, b, a, b]),
            _ => format!("{}({})", function_name(of), arguments.join(", ")),
        }
    }

    /// Conditional expression without events: the compared values change smoothly at the switch.
    fn write_conditional(&self, comparison: &str, [a, b, c, d]: [&str; 4]) -> String {
        format!("if noEvent({a} {comparison} {b}) then {c} else {d}")
    }

    fn write_assignment(&self, name: &str, terms: &[String]) -> String {
        line_wrapping::wrap_sum(&format!("  {name} = "), terms, "\n     ") + ";"
    }

    fn write_solution(&self, mass: &[[String; 4]; 4], forces: &[String; 4]) -> Vec<String> {
        let unknown = ["a_u", "a_v", "a_p", "a_r"];
        let row = |(mass, force): (&[String; 4], &String)| {
            let terms: Vec<String> =
                mass.iter().zip(unknown).map(|(factor, name)| format!("{factor}*{name}")).collect();
            // Implicit equations F = M a; the tool solves them.
            self.write_assignment(force, &terms)
        };
        mass.iter().zip(forces).map(row).collect()
    }

    fn rate_target(&self, place: usize) -> String {
        format!("der({})", STATES[place].0)
    }
}

/// Complete model file.
fn source_text(plan: &ExportPlan) -> String {
    let comment: Vec<String> = header::header_lines(plan)
        .iter()
        .flat_map(|line| line_wrapping::wrap_comment("  //", line))
        .collect();
    let parts = [
        format!(
            "model {} \"Ship manoeuvring model {}\"",
            plan.identifier,
            escape_modelica(&plan.name)
        ),
        comment.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join("\n"),
        input_declarations(plan),
        parameter_declarations(plan),
        state_declarations(plan),
        range_declaration(plan),
        format!("protected\n{}", local_declarations(plan)),
        "equation".to_owned(),
        rates::rate_statements(plan, &ModelicaFormat).join("\n"),
        rudder_equation(plan),
        range_equation(plan),
        format!("end {};\n", plan.identifier),
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

fn input_declarations(plan: &ExportPlan) -> String {
    let one = |name: &str, unit: &str, start: f64, meaning: &str| {
        let meaning = escape_modelica(meaning);
        format!("  input Real {name}(unit = \"{unit}\", start = {start:?}) \"{meaning}\";")
    };
    let order = plan.gear.map(|_| one("delta_order", "rad", 0.0, "ordered rudder"));
    let outside = plan.outside.iter();
    let outside = outside.map(|o| one(&o.identifier, &o.unit, o.default.min(DEEP_M), &o.meaning));
    order.into_iter().chain(outside).collect::<Vec<_>>().join("\n")
}

fn parameter_declarations(plan: &ExportPlan) -> String {
    let one = |c: &ExportCoefficient| {
        let remark = escape_modelica(&header::coefficient_remark(c));
        format!("  parameter Real {} = {:?} \"{remark}\";", c.identifier, c.value)
    };
    plan.coefficients.iter().map(one).collect::<Vec<_>>().join("\n")
}

fn state_declarations(plan: &ExportPlan) -> String {
    let one = |(place, (name, unit, meaning)): (usize, (&str, &str, &str))| {
        let start = if place == 0 { plan.speed_m_s } else { 0.0 };
        format!("  Real {name}(unit = \"{unit}\", start = {start:?}, fixed = true) \"{meaning}\";")
    };
    STATES.into_iter().enumerate().map(one).collect::<Vec<_>>().join("\n")
}

fn range_declaration(plan: &ExportPlan) -> String {
    let known = plan.listed_operations().distance;
    known.map_or(String::new(), |_| {
        format!("  output Real {}(unit = \"1\") \"{}\";", range::NAME, range::MEANING)
    })
}

fn range_equation(plan: &ExportPlan) -> String {
    let Some(range::RangeDistance { mut statements, result }) =
        range::distance_after_rates(plan, &ModelicaFormat)
    else {
        return String::new();
    };
    statements.push(format!("  {} = {result};", range::NAME));
    statements.join("\n")
}

/// Declarations of all names that an equation defines.
fn local_declarations(plan: &ExportPlan) -> String {
    let listed = plan.listed_operations();
    let slots = 0..listed.tape.len() as u32;
    let mut names: Vec<String> = slots
        .filter(|slot| crate::expression::instruction_terms(plan, &ModelicaFormat, *slot).is_some())
        .map(|slot| format!("t{slot}"))
        .collect();
    if listed.mobility.is_none() {
        names.extend(["a_u", "a_v", "a_p", "a_r"].map(str::to_owned));
    }
    names
        .chunks(12)
        .map(|some| format!("  Real {};", some.join(", ")))
        .collect::<Vec<_>>()
        .join("\n")
}

/// Equation of the steering gear. A gear without time constant gets that of the simulation's step,
/// within which it reaches its order.
fn rudder_equation(plan: &ExportPlan) -> String {
    let Some(gear) = &plan.gear else { return "  der(delta) = 0.0;".to_owned() };
    let (limit, fastest) = (gear.limit_rad(), gear.rate_rad_s());
    let time = gear.time_constant_s().max(plan.step_s());
    let ordered = format!("max(-{limit:?}, min({limit:?}, delta_order))");
    let order = match plan.band_rad {
        0.0 => ordered,
        band => format!("min(max(delta, {ordered} - {band:?}), {ordered} + {band:?})"),
    };
    format!("  der(delta) = max(-{fastest:?}, min({fastest:?}, ({order} - delta)/{time:?}));")
}
