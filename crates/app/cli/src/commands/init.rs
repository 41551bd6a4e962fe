//! `sistership init`: the file of a ship, to start from.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde::Serialize;
use sistership_model::Vessel;
use sistership_model::categories::known_categories;
use sistership_model::particulars::{particular_names, plausible_range};

use crate::failure::{Failure, about_file};
use crate::files::OutputFile;
use crate::output;

const EXAMPLES: &str = "\
Examples:
  sistership init my-coaster --category dry-cargo lpp_m=80 beam_m=13 draught_m=5
  sistership init my-ferry --category ferry lpp_m=140 beam_m=24 draught_m=6.2 service_speed_m_s=10

The file lists every particular that a ship may state; those that are not given stand there as
comments and are estimated where a command needs them. All values are in SI units.";

/// Write the file of a ship with its particulars.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct InitArguments {
    /// Name of the ship: small letters, digits and hyphens.
    name: String,
    /// Particulars of the ship.
    #[arg(value_name = "PARTICULAR=VALUE", value_parser = parse_particular)]
    particulars: Vec<(String, f64)>,
    /// Category, within which ships are compared.
    #[arg(long, value_parser = PossibleValuesParser::new(known_categories()))]
    category: String,
    /// Title; by default the name.
    #[arg(long)]
    title: Option<String>,
    /// The file; by default NAME.yaml.
    #[arg(long, value_name = "FILE.yaml")]
    out: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct InitDocument {
    file: PathBuf,
    /// Particulars that are not stated.
    open: Vec<&'static str>,
}

fn parse_particular(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("write PARTICULAR=VALUE, such as lpp_m=80")?;
    let Some((low, high)) = plausible_range(name) else {
        let known: Vec<&str> = particular_names().collect();
        return Err(format!("unknown particular `{name}`; known: {}", known.join(", ")));
    };
    let number: f64 = value.parse().map_err(|_| format!("`{value}` is not a number"))?;
    match (low..=high).contains(&number) {
        true => Ok((name.to_owned(), number)),
        false => Err(format!("{name} is outside {low} to {high}; check the unit")),
    }
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the file exists, cannot be written, or would not be a valid ship.
pub fn run(asked: &InitArguments) -> Result<(), Failure> {
    let file = asked.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.yaml", asked.name)));
    if file.exists() {
        return Err(about_file(&file, "exists already; choose another file by --out"));
    }
    let text = vessel_text(asked);
    // The file is read as every other command will read it, so that a wrong name is refused here.
    Vessel::parse(&file.display().to_string(), &text)?;
    OutputFile::new(&file, &[])?.write(text.as_bytes())?;
    let open = open_particulars(asked).collect();
    let document = InitDocument { file, open };
    output::print_result(asked.json, &document, || {
        format!(
            "{}: {} particulars stated, {} as comments\n",
            document.file.display(),
            asked.particulars.len(),
            document.open.len()
        )
    })
}

fn open_particulars(asked: &InitArguments) -> impl Iterator<Item = &'static str> {
    particular_names().filter(|name| asked.particulars.iter().all(|(given, _)| given != name))
}

fn vessel_text(asked: &InitArguments) -> String {
    let title = asked.title.as_deref().unwrap_or(&asked.name);
    let quoted = |text: &str| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""));
    let mut text = format!(
        "kind: vessel\nname: {}\ntitle: {}\ncategory: {}\nsources:\n  # Name the drawing, booklet \
         or data sheet that states the particulars.\n  owner: {{ citation: {} }}\nparticulars:\n  \
         source: owner\n  values:\n",
        asked.name,
        quoted(title),
        asked.category,
        quoted(&format!("Particulars of {title} as stated by its owner"))
    );
    let mut line = |line: String| writeln!(text, "    {line}").unwrap_or_default();
    for (name, value) in &asked.particulars {
        line(format!("{name}: {value}"));
    }
    for name in open_particulars(asked) {
        let (low, high) = plausible_range(name).unwrap_or_default();
        line(format!("# {name}:  # {low} to {high}"));
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn asked(folder: &std::path::Path, name: &str) -> InitArguments {
        InitArguments {
            name: name.into(),
            particulars: vec![("lpp_m".into(), 80.0), ("beam_m".into(), 13.0)],
            category: "dry-cargo".into(),
            title: Some("The \"Coaster\"".into()),
            out: Some(folder.join("ship.yaml")),
            json: false,
        }
    }

    #[test]
    fn the_file_is_a_ship_that_lists_every_particular() {
        let folder = tempfile::tempdir().unwrap();
        run(&asked(folder.path(), "coaster")).unwrap();
        let text = std::fs::read_to_string(folder.path().join("ship.yaml")).unwrap();
        let vessel = Vessel::parse("ship.yaml", &text).unwrap();
        assert_eq!(vessel.particular("lpp_m"), Some(80.0));
        assert!(particular_names().all(|name| text.contains(&format!("{name}:"))), "{text}");
        // Nothing is overwritten.
        let again = run(&asked(folder.path(), "coaster")).unwrap_err();
        assert!(again.message().unwrap().contains("exists already"));
    }

    #[test]
    fn a_wrong_name_and_a_wrong_particular_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(run(&asked(folder.path(), "My Ship")).is_err());
        assert!(!folder.path().join("ship.yaml").exists());
        assert!(parse_particular("lpp_m=80000").unwrap_err().contains("check the unit"));
        assert!(parse_particular("length=80").unwrap_err().contains("lpp_m"));
        assert!(parse_particular("lpp_m").unwrap_err().contains("PARTICULAR=VALUE"));
    }
}
