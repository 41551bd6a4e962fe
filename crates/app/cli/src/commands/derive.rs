//! `sistership derive`: derivation of a law of motion from a list of actuators.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use sistership_model::hybrid::{LawDerivation, UnknownCounts, derive_law};
use sistership_model::law::LawFile;
use sistership_model::{FileError, Zoo};

use crate::failure::Failure;
use crate::files::OutputFile;
use crate::table::TextTable;
use crate::zoo::read_text_file;
use crate::{output, resolve};

const EXAMPLES: &str = "\
Examples:
  sistership derive my-ferry.yaml
  sistership derive my-ferry.yaml --out zoo/laws/my-ferry.yaml
  sistership derive my-ferry.yaml --json

A declaration is of `kind: hybrid`; models/hybrids/README.md has one with every field.";

/// Derive the Abkowitz-MMG hybrid of a ship from its actuators, and count its unknowns rule by
/// rule.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct DeriveArguments {
    /// The declaration: actuators, order, rules, submodels.
    declaration: PathBuf,
    /// Write the law to a file.
    #[arg(long, value_name = "LAW.yaml")]
    out: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct DeriveDocument<'a> {
    name: &'a str,
    order: u32,
    #[serde(flatten)]
    unknowns: &'a UnknownCounts,
    submodels: Vec<&'a str>,
    law: &'a LawFile,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the declaration is refused, or if the law cannot be written.
pub fn run(zoo: &Zoo, asked: &DeriveArguments) -> Result<(), Failure> {
    let path = &asked.declaration;
    // The output file is checked before the work.
    let promised = asked
        .out
        .as_deref()
        .map(|out| OutputFile::new(out, std::slice::from_ref(path)))
        .transpose()?;
    let text = read_text_file(path)?;
    resolve::check_kind(path, &text, "hybrid", "a declaration")?;
    let derived = derive_law(&path.display().to_string(), &text)?;
    let unknowns =
        derived.count_unknowns(zoo).map_err(|(field, message)| file_error(path, field, message))?;
    // Written after all checks, so that a refused declaration leaves no law.
    if let Some(promised) = promised {
        promised.write(derived.text.as_bytes())?;
    }
    let submodels = derived.law.submodels.keys().map(String::as_str).collect();
    let document = DeriveDocument {
        name: &derived.law.name,
        order: derived.file.order,
        unknowns: &unknowns,
        submodels,
        law: &derived.law_file,
    };
    output::print_result(asked.json, &document, || {
        format_report(&derived, &unknowns, asked.out.as_deref())
    })
}

fn file_error(path: &Path, field: String, message: String) -> FileError {
    FileError { file: path.display().to_string(), line: None, field, message, further: Vec::new() }
}

fn format_report(derived: &LawDerivation, unknowns: &UnknownCounts, out: Option<&Path>) -> String {
    let mut table = TextTable::new(["rule", "setting", "X", "Y", "N", "all"]);
    for rule in &unknowns.rules {
        let counts = [rule.x, rule.y, rule.n, rule.total].map(|count| count.to_string());
        table.add_row([rule.rule.to_owned(), rule.setting.clone()].into_iter().chain(counts));
    }
    let written = out.map_or(String::new(), |out| format!("\nlaw written to {}", out.display()));
    format!(
        "{}: {}\n\n{table}\n{}{written}",
        derived.law.name,
        derived.law.title,
        format_unknowns(derived, unknowns)
    )
}

/// Formats the number of unknowns: coefficients by set, inertia and effects.
fn format_unknowns(derived: &LawDerivation, unknowns: &UnknownCounts) -> String {
    let mut table = TextTable::new(["unknowns", "of", "number"]);
    // The shared set first, then one for each regime.
    let sets: Vec<&str> =
        std::iter::once("shared").chain(derived.law.submodels.keys().map(String::as_str)).collect();
    let mut row = |what: &str, of: String, count: usize| {
        table.add_row([what.to_owned(), of, count.to_string()])
    };
    row(
        "coefficients",
        format!("{} sets: {}", unknowns.coefficient_sets, sets.join(", ")),
        unknowns.coefficients,
    );
    row("inertia", unknowns.parameters.join(", "), unknowns.parameters.len());
    for effect in &unknowns.effects {
        row("effect", format!("{}, {}", effect.effect, effect.form), effect.unknowns);
    }
    row("all", String::new(), unknowns.unknowns);
    table.to_string()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const DECLARATION: &str = "kind: hybrid\nname: ferry\ntitle: A ferry\norder: 2\nactuators: { \
                               n: { kind: propeller }, delta: { kind: vectwin } }\nsubmodels: \
                               ahead_astern\neffects: [{ effect: wind, form: measured }]\n";

    fn asked(folder: &Path, text: &str) -> DeriveArguments {
        let declaration = folder.join("ferry.yaml");
        std::fs::write(&declaration, text).unwrap();
        DeriveArguments { declaration, out: Some(folder.join("law.yaml")), json: false }
    }

    #[test]
    fn the_law_is_written_and_its_unknowns_counted() {
        let folder = tempfile::tempdir().unwrap();
        let asked = asked(folder.path(), DECLARATION);
        let zoo = Zoo::load_embedded().unwrap();
        run(&zoo, &asked).unwrap();
        let text = std::fs::read_to_string(folder.path().join("law.yaml")).unwrap();
        let law = sistership_model::Law::parse("law.yaml", &text).unwrap();
        assert_eq!(law.coefficient_names().len(), 120);
        let derived = derive_law("ferry.yaml", DECLARATION).unwrap();
        let report = format_report(&derived, &derived.count_unknowns(&zoo).unwrap(), None);
        for part in ["A: symmetry", "2 sets: shared, astern", "133"] {
            assert!(report.contains(part), "{part} in\n{report}");
        }
    }

    #[test]
    fn faults_name_file_and_field_and_leave_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let zoo = Zoo::load_embedded().unwrap();
        let refused = |from: &str, to: &str| {
            let asked = asked(folder.path(), &DECLARATION.replace(from, to));
            run(&zoo, &asked).unwrap_err().message().unwrap().to_owned()
        };
        assert!(refused("order: 2", "order: 0").contains("ferry.yaml:4: order"));
        assert!(
            refused("form: measured", "form: felt").contains("effects: `wind` has no form `felt`")
        );
        assert!(
            refused("kind: hybrid", "kind: law")
                .contains("is of `kind: law`; a declaration is of `kind: hybrid`")
        );
        assert!(refused("kind: hybrid\n", "").contains("is not a declaration"));
        assert!(!folder.path().join("law.yaml").exists());
    }
}
