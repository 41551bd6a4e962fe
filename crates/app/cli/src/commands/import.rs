//! `sistership import`: looks at files and writes the manifest that reads them.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use sistership_model::trial::Trial;
use sistership_model::{FileError, Zoo};
use sistership_trials::{Guess, Loaded, lacking, load_path, propose};

use super::import_bundle;
use super::import_log::{SearchedLog, searched};
use super::store::StoreArguments;
use crate::failure::{Failure, about_file};
use crate::files::PromisedFile;
use crate::output::{self, count, note};
use crate::table::TextTable;
use crate::trials::place;
use crate::values::positive;

const EXAMPLES: &str = "\
Examples:
  sistership import log/*.csv --ship my-ship
  sistership import voyage.nmea --ship my-ship --out trials.yaml
  sistership import month.parquet --ship mariner --out trials.yaml
  sistership import --bundle my-ship.bundle --data-dir sistership-data

Every guess is shown with its reason; those marked `look` are to be read over. The manifest is then
used in place of the files: sistership refine --trials trials.yaml

Of a log of many hours the stretches in which rudder or propeller move beyond course keeping become
trials, each with the reason; the table also says what is left, steady course keeping.

Exit status 1 when a file cannot be read, or is refused by the manifest that was written.";

/// Look at trial files and write a manifest that reads them.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ImportArguments {
    /// Files of one folder: CSV, Parquet, Excel, MATLAB 5, NMEA 0183.
    #[arg(required_unless_present = "bundle")]
    files: Vec<PathBuf>,
    /// The ship that the trials are of.
    #[arg(long, value_name = "NAME", required_unless_present = "bundle")]
    ship: Option<String>,
    /// Where the manifest goes; `trials.yaml` beside the files where absent.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The ship's length between perpendiculars: stretches of a long log are told by lengths
    /// sailed. Where absent, that of the zoo's ship of this name, or else one that suits the speed.
    #[arg(long, value_name = "METRES", value_parser = positive, allow_negative_numbers = true)]
    length: Option<f64>,
    /// Take a ship that `sistership export --format bundle` wrote into a store.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["files", "ship", "out", "length"])]
    bundle: Option<PathBuf>,
    /// Take a bundle only if one of these keys has signed it (Ed25519, PEM).
    #[arg(long, value_name = "FILE", requires = "bundle")]
    signed_by: Vec<PathBuf>,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

impl ImportArguments {
    /// The ship's name; clap has seen that there is one.
    fn ship(&self) -> &str {
        self.ship.as_deref().unwrap_or_default()
    }
}

/// What was made of the files.
#[derive(Serialize)]
struct Import {
    manifest: PathBuf,
    guesses: Vec<GuessRow>,
    /// Files of which stretches were taken.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    logs: Vec<SearchedLog>,
    trials: Vec<String>,
    errors: Vec<String>,
    /// By law, what the trials do not have; laws for which nothing is missing are empty.
    lacking: Vec<LawNeeds>,
}

#[derive(Serialize)]
struct GuessRow {
    file: String,
    column: String,
    channel: Option<String>,
    unit: Option<String>,
    certain: bool,
    why: String,
}

#[derive(Serialize)]
struct LawNeeds {
    law: String,
    lacks: Vec<String>,
}

impl From<Guess> for GuessRow {
    fn from(guess: Guess) -> Self {
        let Guess { file, column, channel, unit, why, certain } = guess;
        Self { file, column, channel, unit, certain, why }
    }
}

/// Runs the command.
///
/// # Errors
/// Each file that cannot be read, or that the manifest cannot be written.
pub fn run(zoo: &Zoo, arguments: &ImportArguments) -> Result<(), Failure> {
    if let Some(bundle) = &arguments.bundle {
        return import_bundle::run(bundle, &arguments.signed_by, &arguments.store, arguments.json);
    }
    let out = arguments.out.clone().unwrap_or_else(|| beside(&arguments.files));
    if arguments.out.is_none() && out.exists() {
        return Err(about_file(&out, "is there already; name another place with --out"));
    }
    let promised = PromisedFile::new(&out, &arguments.files)?;
    let files: Vec<&Path> = arguments.files.iter().map(PathBuf::as_path).collect();
    let mut proposal = propose(arguments.ship(), &files).map_err(all)?;
    let logs = searched(&mut proposal.manifest, folder(&arguments.files), length(zoo, arguments));
    let text = proposal.manifest.to_yaml().map_err(|error| about_file(&out, error))?;
    promised.write(text.as_bytes())?;
    let guesses = proposal.guesses.into_iter().map(GuessRow::from).collect();
    let import = Import { logs, ..checked(zoo, out, guesses)? };
    output::print(arguments.json, &import, || text_of(&import))?;
    if import.errors.is_empty() { Ok(()) } else { Err(Failure::Told) }
}

fn beside(files: &[PathBuf]) -> PathBuf {
    folder(files).join("trials.yaml")
}

fn folder(files: &[PathBuf]) -> &Path {
    files.first().and_then(|file| file.parent()).unwrap_or_else(|| Path::new(""))
}

/// The ship's length: as given, or of the ship of that name in the zoo.
fn length(zoo: &Zoo, arguments: &ImportArguments) -> Option<f64> {
    let known =
        || zoo.vessel(arguments.ship())?.particulars.get("lpp_m").map(|quantity| quantity.value);
    arguments.length.or_else(known)
}

fn all(errors: Vec<FileError>) -> Failure {
    let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
    Failure::Refused(lines.join("\n"))
}

/// The manifest held against its files, and their trials against the laws.
fn checked(zoo: &Zoo, manifest: PathBuf, guesses: Vec<GuessRow>) -> Result<Import, Failure> {
    let Loaded { trials: read, .. } = load_path(&manifest)?;
    let (mut trials, mut errors) = (Vec::new(), Vec::new());
    for one in read {
        match one {
            Ok(trial) => trials.push(trial),
            Err(refusal) => errors.extend(
                refusal
                    .findings
                    .iter()
                    .map(|finding| format!("{}: {}", refusal.file, place(finding))),
            ),
        }
    }
    for warning in trials.iter().flat_map(|trial| {
        trial.warnings.iter().map(move |warning| format!("{}: {}", trial.name, place(warning)))
    }) {
        note(&format!("note: {warning}"));
    }
    let needs = trials.first().map_or_else(Vec::new, |trial| needs(zoo, trial));
    let names = trials.into_iter().map(|trial| trial.name).collect();
    Ok(Import { manifest, guesses, logs: Vec::new(), trials: names, errors, lacking: needs })
}

fn needs(zoo: &Zoo, trial: &Trial) -> Vec<LawNeeds> {
    let of = |law: &std::sync::Arc<sistership_model::Law>| LawNeeds {
        law: law.name.clone(),
        lacks: lacking(law, trial).iter().map(ToString::to_string).collect(),
    };
    zoo.laws().map(of).collect()
}

fn text_of(import: &Import) -> String {
    let mut table = TextTable::new(["file", "column", "read as", "unit", "", "why"]);
    for guess in &import.guesses {
        let channel = guess.channel.clone().unwrap_or_else(|| "-".into());
        let unit = guess.unit.clone().unwrap_or_default();
        let look = if guess.certain { "" } else { "look" };
        let cells = [&guess.file, &guess.column, &channel, &unit];
        let cells = cells.into_iter().cloned();
        table.row(cells.chain([look.to_owned(), guess.why.clone()]));
    }
    let logs: String = import.logs.iter().map(ToString::to_string).collect();
    let errors: String = import.errors.iter().map(|error| format!("error: {error}\n")).collect();
    let trials = count(import.trials.len(), "trial");
    format!(
        "{table}\n{logs}{errors}{}\n{}: {trials} read\n",
        laws(&import.lacking),
        import.manifest.display()
    )
}

/// Which laws can be fitted, and what the others lack.
fn laws(needs: &[LawNeeds]) -> String {
    let (ready, lacking): (Vec<&LawNeeds>, Vec<&LawNeeds>) =
        needs.iter().partition(|need| need.lacks.is_empty());
    let names: Vec<&str> = ready.iter().map(|need| need.law.as_str()).collect();
    let can = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    let lines: String =
        lacking.iter().map(|need| format!("  {}: {}\n", need.law, need.lacks.join("; "))).collect();
    let others = if lines.is_empty() { String::new() } else { format!("Others:\n{lines}") };
    format!("Laws that these trials can be fitted with: {can}\n{others}")
}
