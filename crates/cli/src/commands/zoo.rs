//! `sistership zoo`: what the zoo is worth, and the check of a ship that is to join it.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use serde::Serialize;
use sistership_model::Zoo;
use sistership_validation::{Appraisal, Review, Severity, appraise_vessel, review};

use super::zoo_text;
use crate::failure::{Failure, about_file};
use crate::files::PromisedFile;
use crate::zoo::text_of;
use crate::{named, output};

const EXAMPLES: &str = "\
Examples:
  sistership zoo list
  sistership zoo list kvlcc2 wpcc --json
  sistership zoo add my-ship.yaml
  sistership zoo add my-ship.yaml --into zoo
  sistership manoeuvre --zoo zoo --model my-ship --all";

/// The zoo: what its models are worth, and a ship that is to join it.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ZooArguments {
    #[command(subcommand)]
    what: ZooAction,
    /// Print one JSON document.
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum ZooAction {
    /// Every model with its law, its status and the published trials that it is held against.
    List {
        /// Ships; all where none is named.
        #[arg(value_name = "SHIP")]
        ships: Vec<String>,
    },
    /// Check a ship's file: schema, units, particulars, physics, published trials; and say what a
    /// reviewer should look at.
    Add {
        /// The vessel file.
        file: PathBuf,
        /// Copy it into `DIR/vessels` where nothing is refused.
        #[arg(long, value_name = "DIR")]
        into: Option<PathBuf>,
    },
}

/// Runs the command.
///
/// # Errors
/// A file is refused, by its reader or by physics.
pub fn run(zoo: &Zoo, asked: &ZooArguments) -> Result<(), Failure> {
    match &asked.what {
        ZooAction::List { ships } => list(zoo, ships, asked.json),
        ZooAction::Add { file, into } => add(zoo, file, into.as_deref(), asked.json),
    }
}

#[derive(Serialize)]
struct ListDocument {
    models: Vec<Appraisal>,
}

fn list(zoo: &Zoo, ships: &[String], json: bool) -> Result<(), Failure> {
    let vessels = match ships {
        [] => zoo.vessels().cloned().collect(),
        names => names.iter().map(|name| named::ship(zoo, name)).collect::<Result<Vec<_>, _>>()?,
    };
    let mut models = Vec::new();
    for vessel in vessels {
        models.extend(appraise_vessel(zoo, &vessel)?);
    }
    let document = ListDocument { models };
    output::print(json, &document, || zoo_text::listed(&document.models))
}

#[derive(Serialize)]
struct AddDocument<'a> {
    #[serde(flatten)]
    review: &'a Review,
    taken: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    written: Option<PathBuf>,
}

fn add(
    zoo: &Zoo,
    file: &std::path::Path,
    into: Option<&std::path::Path>,
    json: bool,
) -> Result<(), Failure> {
    let vessel = named::vessel_file(zoo, file)?;
    let review = review(zoo, &vessel)?;
    let taken = review.is_taken();
    let written = match into.filter(|_| taken) {
        Some(zoo_folder) => Some(copied(file, zoo_folder, vessel.name())?),
        None => None,
    };
    let document = AddDocument { review: &review, taken, written };
    output::print(json, &document, || zoo_text::reviewed(&review, document.written.as_deref()))?;
    let refused = |finding: &&sistership_validation::Finding| finding.severity == Severity::Refused;
    match review.findings.iter().filter(refused).count() {
        0 => Ok(()),
        _ => Err(Failure::Told),
    }
}

/// The file as a vessel of a zoo of one's own; what stands there already is not replaced.
fn copied(
    file: &std::path::Path,
    zoo_folder: &std::path::Path,
    name: &str,
) -> Result<PathBuf, Failure> {
    let vessels = zoo_folder.join("vessels");
    std::fs::create_dir_all(&vessels)
        .map_err(|error| about_file(&vessels, format!("cannot be made a folder: {error}")))?;
    let path = vessels.join(format!("{name}.yaml"));
    if path.exists() {
        return Err(about_file(&path, "is there already; move it away first"));
    }
    let text = text_of(file)?;
    PromisedFile::new(&path, &[])?.write(text.as_bytes())?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn asked(what: ZooAction) -> ZooArguments {
        ZooArguments { what, json: true }
    }

    #[test]
    fn a_ship_joins_by_a_file_and_one_that_turns_the_wrong_way_does_not() {
        let zoo = Zoo::embedded().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("ship.yaml");
        let into = Some(folder.path().join("own"));
        let text = zoo.vessel_text("mariner").unwrap().replace("name: mariner", "name: liberty");
        std::fs::write(&file, &text).unwrap();
        run(&zoo, &asked(ZooAction::Add { file: file.clone(), into: into.clone() })).unwrap();
        let added = folder.path().join("own/vessels/liberty.yaml");
        assert_eq!(std::fs::read_to_string(&added).unwrap(), text);
        let again = run(&zoo, &asked(ZooAction::Add { file: file.clone(), into })).unwrap_err();
        assert!(again.message().unwrap().contains("is there already"));
        let wrong = text.replace("rudder_positive: port_turn", "rudder_positive: starboard_turn");
        assert_ne!(wrong, text);
        std::fs::write(&file, wrong).unwrap();
        let elsewhere = Some(folder.path().join("other"));
        let refused = run(&zoo, &asked(ZooAction::Add { file, into: elsewhere })).unwrap_err();
        assert_eq!(refused, Failure::Told);
        assert!(!folder.path().join("other").exists());
    }

    #[test]
    fn the_list_names_unknown_ships() {
        let zoo = Zoo::embedded().unwrap();
        let refused =
            run(&zoo, &asked(ZooAction::List { ships: vec!["marinr".into()] })).unwrap_err();
        assert!(refused.message().unwrap().contains("did you mean `mariner`"));
    }
}
