//! `sistership zoo`: validation status of the zoo, and check of a ship that is to be added.

use std::path::PathBuf;
use std::sync::Arc;

use clap::{Args, Subcommand};
use serde::Serialize;
use sistership_assessment::validation::{
    CatalogueEntry, ModelAppraisal, Severity, ShipReview, appraise_vessel, review_ship,
};
use sistership_model::{Vessel, Zoo};

use super::zoo_text;
use crate::failure::{Failure, about_file};
use crate::files::OutputFile;
use crate::zoo::read_text_file;
use crate::{output, resolve};

const EXAMPLES: &str = "\
Examples:
  sistership zoo list
  sistership zoo list kvlcc2 wpcc --json
  sistership zoo add my-ship.yaml
  sistership zoo add my-ship.yaml --into zoo --page my-ship.md
  sistership zoo cite kvlcc2 --json
  sistership manoeuvre --zoo zoo --model my-ship --all";

/// List the models of the zoo with their validation status, or check a ship before it is added.
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
    /// List every model with its law, its validation status and the published trials it was
    /// compared with.
    List {
        /// Ships; all by default.
        #[arg(value_name = "SHIP")]
        ships: Vec<String>,
    },
    /// Check a vessel file: schema, units, particulars, physics, published trials; list what a
    /// reviewer should examine.
    Add {
        /// The vessel file.
        file: PathBuf,
        /// Copy it to `DIR/vessels` if nothing is refused.
        #[arg(long, value_name = "DIR")]
        into: Option<PathBuf>,
        /// Write a page about the ship (Markdown), accepted or not.
        #[arg(long, value_name = "FILE")]
        page: Option<PathBuf>,
    },
    /// Cite the sources of the data of a ship and their licences; with `--json` as schema.org
    /// Dataset.
    Cite {
        /// Ships or vessel files; all ships of the zoo by default.
        #[arg(value_name = "SHIP")]
        ships: Vec<String>,
    },
}

/// Runs the command.
///
/// # Errors
/// Returns an error if a file is refused, by its format or by physics.
pub fn run(zoo: &Zoo, asked: &ZooArguments) -> Result<(), Failure> {
    match &asked.what {
        ZooAction::List { ships } => list_models(zoo, ships, asked.json),
        ZooAction::Add { file, into, page } => {
            add_ship(zoo, file, into.as_deref(), page.as_deref(), asked.json)
        }
        ZooAction::Cite { ships } => cite_sources(zoo, ships, asked.json),
    }
}

#[derive(Serialize)]
struct CiteDocument {
    #[serde(rename = "@graph")]
    graph: Vec<CatalogueEntry>,
}

fn cite_sources(zoo: &Zoo, ships: &[String], json: bool) -> Result<(), Failure> {
    let graph = select_vessels(zoo, ships)?
        .iter()
        .map(|vessel| CatalogueEntry::from_vessel(vessel))
        .collect();
    let document = CiteDocument { graph };
    output::print_result(json, &document, || zoo_text::format_citations(&document.graph))
}

fn select_vessels(zoo: &Zoo, ships: &[String]) -> Result<Vec<Arc<Vessel>>, Failure> {
    match ships {
        [] => Ok(zoo.vessels().cloned().collect()),
        names => names.iter().map(|name| resolve::resolve_ship(zoo, name)).collect(),
    }
}

#[derive(Serialize)]
struct ListDocument {
    models: Vec<ModelAppraisal>,
}

fn list_models(zoo: &Zoo, ships: &[String], json: bool) -> Result<(), Failure> {
    let mut models = Vec::new();
    for vessel in select_vessels(zoo, ships)? {
        models.extend(appraise_vessel(zoo, &vessel)?);
    }
    let document = ListDocument { models };
    output::print_result(json, &document, || zoo_text::format_models(&document.models))
}

#[derive(Serialize)]
struct AddDocument<'a> {
    #[serde(flatten)]
    review: &'a ShipReview,
    taken: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    written: Option<PathBuf>,
}

fn add_ship(
    zoo: &Zoo,
    file: &std::path::Path,
    into: Option<&std::path::Path>,
    page: Option<&std::path::Path>,
    json: bool,
) -> Result<(), Failure> {
    // The page is written also for a refused ship: it says what to change.
    let page = page.map(|path| OutputFile::new(path, &[file.to_owned()])).transpose()?;
    let vessel = resolve::vessel_file(zoo, file)?;
    // A file that cannot be parsed never gets here; the review is about its content.
    let review = review_ship(zoo, &vessel)?;
    if let Some(page) = page {
        page.write(sistership_report::contributed_ship_page(&vessel, &review).as_bytes())?;
    }
    let taken = review.is_acceptable();
    let written = match into.filter(|_| taken) {
        Some(zoo_folder) => Some(copy_vessel(file, zoo_folder, vessel.name())?),
        None => None,
    };
    let document = AddDocument { review: &review, taken, written };
    output::print_result(json, &document, || {
        zoo_text::format_review(&review, document.written.as_deref())
    })?;
    let refused = |finding: &&sistership_assessment::validation::ReviewFinding| {
        finding.severity == Severity::Refused
    };
    match review.findings.iter().filter(refused).count() {
        0 => Ok(()),
        _ => Err(Failure::Told),
    }
}

/// Copies the file into a zoo folder; an existing file is not replaced.
fn copy_vessel(
    file: &std::path::Path,
    zoo_folder: &std::path::Path,
    name: &str,
) -> Result<PathBuf, Failure> {
    let vessels = zoo_folder.join("vessels");
    std::fs::create_dir_all(&vessels)
        .map_err(|error| about_file(&vessels, format!("the folder cannot be created: {error}")))?;
    let path = vessels.join(format!("{name}.yaml"));
    // A vessel may have been edited in the zoo folder.
    if path.exists() {
        return Err(about_file(&path, "exists already; move it away first"));
    }
    let text = read_text_file(file)?;
    OutputFile::new(&path, &[])?.write(text.as_bytes())?;
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
        let zoo = Zoo::load_embedded().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("ship.yaml");
        let into = Some(folder.path().join("own"));
        let text = zoo.vessel_text("mariner").unwrap().replace("name: mariner", "name: liberty");
        std::fs::write(&file, &text).unwrap();
        let page = folder.path().join("liberty.md");
        let first =
            ZooAction::Add { file: file.clone(), into: into.clone(), page: Some(page.clone()) };
        run(&zoo, &asked(first)).unwrap();
        let page = std::fs::read_to_string(page).unwrap();
        assert!(page.starts_with("# liberty\n"), "{page}");
        assert!(page.contains("| lpp_m | 160.93 |"), "{page}");
        assert!(page.contains("| `abkowitz` | `abkowitz` | published |"), "{page}");
        let added = folder.path().join("own/vessels/liberty.yaml");
        assert_eq!(std::fs::read_to_string(&added).unwrap(), text);
        let again =
            run(&zoo, &asked(ZooAction::Add { file: file.clone(), into, page: None })).unwrap_err();
        assert!(again.message().unwrap().contains("exists already"));
        let wrong = text.replace("rudder_positive: port_turn", "rudder_positive: starboard_turn");
        assert_ne!(wrong, text);
        std::fs::write(&file, wrong).unwrap();
        let elsewhere = Some(folder.path().join("other"));
        let refused =
            run(&zoo, &asked(ZooAction::Add { file, into: elsewhere, page: None })).unwrap_err();
        assert_eq!(refused, Failure::Told);
        assert!(!folder.path().join("other").exists());
    }

    #[test]
    fn the_list_names_unknown_ships() {
        let zoo = Zoo::load_embedded().unwrap();
        let refused =
            run(&zoo, &asked(ZooAction::List { ships: vec!["marinr".into()] })).unwrap_err();
        assert!(refused.message().unwrap().contains("did you mean `mariner`"));
    }
}
