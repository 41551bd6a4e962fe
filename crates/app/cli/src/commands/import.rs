//! `sistership import`: identification of the columns of trial files, and their manifest.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use sistership_jobs::stated_revolutions::state_revolutions;
use sistership_model::trial::Trial;
use sistership_model::{FileError, Vessel, Zoo};
use sistership_trials::{
    CleanedTrials, ColumnGuess, GivenColumn, ImportTemplate, ManifestFile, ProposalRequest,
    Refusal, Role, estimate_currents, load_cleaned, missing_channels, propose_files,
};

use super::import_bundle;
use super::import_files::input_files;
use super::import_log::segment_logs;
use super::import_outcome::{GuessRow, ImportDocument, LawNeeds};
use super::import_template::{TemplateFolder, template_name};
use super::import_text;
use super::store::StoreArguments;
use crate::failure::{Failure, about_file};
use crate::files::OutputFile;
use crate::output;
use crate::resolve::vessel_file;
use crate::trials::format_finding;
use crate::values::positive;

const EXAMPLES: &str = "\
Examples:
  sistership import log/*.csv
  sistership import voyage.nmea --ship my-ship --out trials.yaml
  sistership import runs --column 'Azi=delta:deg:reversed' --explain
  sistership import yard/*.xlsx --column 'Kurs=psi:deg' --save-template yard-x
  sistership import yard/next.xlsx --template yard-x
  sistership import --bundle my-ship.bundle --data-dir sistership-data

Columns are identified by their names (in nine languages), their values and the relations between
them, and the reason is reported. Where two readings are nearly equally likely, one question is
asked, with the `--column` option that answers it. Faulty values are excluded in the manifest, which
can be edited. Use the manifest in place of the files: sistership refine --trials trials.yaml

A log of many hours is divided into segments: those with manoeuvres become trials, each with the
reason; the rest is listed as steady course keeping.

Exit status 1 when a file cannot be read, or is refused by the manifest that was written.";

/// Identify the columns of trial files and write a manifest that reads them.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ImportArguments {
    /// Files, or folders of them: CSV and similar text, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX,
    /// NMEA 0183 and NMEA 2000 logs, MCAP.
    #[arg(required_unless_present = "bundle")]
    files: Vec<PathBuf>,
    /// Ship of the trials, by name or by its file, whose `actuators` name columns; `refine --ship`
    /// may name it instead.
    #[arg(long, value_name = "SHIP", default_value = "", hide_default_value = true)]
    ship: String,
    /// Write the manifest to this file; by default `trials.yaml` in the common folder of all files.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Meaning of a column, to answer a question or correct a guess:
    /// HEADER=CHANNEL[:UNIT[:reversed]], or HEADER= to ignore the column; `#3` is the third column
    /// of a file without a header.
    #[arg(long = "column", value_name = "COLUMN", value_parser = given_column)]
    columns: Vec<GivenColumn>,
    /// Read the columns as a template says, which `--save-template` kept; `--column` goes before it.
    /// Templates are YAML files in SISTERSHIP_TEMPLATES, or else in the user's folder of settings.
    #[arg(long, value_name = "NAME", value_parser = template_name)]
    template: Option<String>,
    /// Keep how the columns are read as a template, in place of one of the same name.
    #[arg(long, value_name = "NAME", value_parser = template_name)]
    save_template: Option<String>,
    /// List every column of every file with the reason for its reading.
    #[arg(long)]
    explain: bool,
    /// Length between perpendiculars, which scales the segmentation of a long log; the default is
    /// the length of the zoo's ship of this name, or else a length typical of the speed.
    #[arg(long, value_name = "METRES", value_parser = positive, allow_negative_numbers = true)]
    length: Option<f64>,
    /// Import a ship from a bundle of `sistership export --format bundle` into a store.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["files", "ship", "out", "length"])]
    bundle: Option<PathBuf>,
    /// Import a bundle only if it is signed with one of these keys (Ed25519, PEM).
    #[arg(long, value_name = "FILE", requires = "bundle")]
    signed_by: Vec<PathBuf>,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Parses a column that the user defines.
fn given_column(text: &str) -> Result<GivenColumn, String> {
    let (header, rest) = text
        .rsplit_once('=')
        .ok_or("write HEADER=CHANNEL[:UNIT[:reversed]], or HEADER= to ignore the column")?;
    let mut parts = rest.split(':');
    let name = parts.next().unwrap_or_default().trim();
    let role = match name {
        "" => None,
        name => {
            Some(Role::from_name(name).ok_or_else(|| format!("`{name}` is not a channel name"))?)
        }
    };
    // An empty unit leaves the unit to the identification.
    let unit = parts.next().map(|unit| unit.trim().to_owned()).filter(|unit| !unit.is_empty());
    if let (Some(role), Some(unit)) = (role, &unit) {
        let known = role.kind().known_units().iter().map(|unit| unit.name);
        let known: Vec<&str> =
            known.chain(role.kind().percent_unit().map(|unit| unit.name)).collect();
        if !known.contains(&unit.as_str()) {
            return Err(format!("`{unit}` does not fit {name}; use one of {}", known.join(", ")));
        }
    }
    let is_reversed = match parts.next() {
        // A given unit settles the sign, too; without one the sign stays open.
        None => unit.as_ref().map(|_| false),
        Some("reversed") => Some(true),
        Some(other) => return Err(format!("`{other}` is not known; write `reversed` or nothing")),
    };
    Ok(GivenColumn { header: header.to_owned(), role, unit, is_reversed })
}

/// Runs the command.
///
/// # Errors
/// Returns an error that lists each file that cannot be read, or if the manifest cannot be written.
pub fn run(zoo: &Zoo, arguments: &ImportArguments) -> Result<(), Failure> {
    if let Some(bundle) = &arguments.bundle {
        return import_bundle::run_import(
            bundle,
            &arguments.signed_by,
            &arguments.store,
            arguments.json,
        );
    }
    let paths = input_files(&arguments.files)?;
    let out = arguments.out.clone().unwrap_or_else(|| default_manifest(&paths));
    // A manifest may have been edited by hand; only an explicit --out replaces it.
    if arguments.out.is_none() && out.exists() {
        return Err(about_file(&out, "exists already; choose another file with --out"));
    }
    let promised = OutputFile::new(&out, &paths)?;
    let files: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
    let folder = out.parent().unwrap_or(Path::new(""));
    let vessel = named_vessel(zoo, &arguments.ship)?;
    let named = vessel.iter().flat_map(|vessel| actuator_columns(vessel));
    let given: Vec<GivenColumn> = given_columns(arguments)?.into_iter().chain(named).collect();
    let request = ProposalRequest {
        ship: vessel.as_ref().map_or(arguments.ship.as_str(), |vessel| vessel.name()),
        files: &files,
        folder: Some(folder),
        given: &given,
    };
    let mut proposal = propose_files(&request).map_err(join_errors)?;
    // Segmentation first: faults are then searched only in the segments that become trials.
    let logs =
        segment_logs(&mut proposal.manifest, folder, ship_length(vessel.as_deref(), arguments));
    // One pass: trials as the manifest with the exclusions gives them.
    let CleanedTrials { trials, excluded } =
        with_draft(&proposal.manifest, folder, |draft| Ok(load_cleaned(draft)?))?;
    proposal.manifest.declarations.exclude.clone_from(&excluded);
    let (mut trials, errors) = accepted_trials(trials);
    // With columns a manifest helps to put the files right, even if none is accepted yet.
    if proposal.guesses.is_empty() && trials.is_empty() {
        return Err(Failure::Refused(errors.join("\n")));
    }
    let currents = estimate_currents(&trials);
    proposal.manifest.declarations.currents.clone_from(&currents);
    let listed = &mut proposal.manifest.manifest.trials;
    let revolutions = state_revolutions(zoo, vessel.as_deref(), listed, &mut trials);
    let text = proposal.manifest.to_yaml().map_err(|error| about_file(&out, error))?;
    promised.write(text.as_bytes())?;
    let (guesses, mut notes) = (proposal.guesses, proposal.notes);
    notes.extend(template_notes(arguments, &guesses)?);
    notes.extend(revolutions);
    let guesses = guesses.into_iter().map(GuessRow::from).collect();
    let explain = arguments.explain;
    let import = ImportDocument {
        manifest: out,
        guesses,
        notes,
        logs,
        excluded,
        currents,
        // Laws are fitted to all trials together: the one that lacks most decides.
        lacking: trials
            .iter()
            .map(|trial| law_needs(zoo, trial))
            .max_by_key(|needs| needs.iter().map(|need| need.lacks.len()).sum::<usize>())
            .unwrap_or_default(),
        trials: trials.into_iter().map(|trial| trial.name).collect(),
        errors,
        explain,
    };
    output::print_result(arguments.json, &import, || import_text::format_import(&import))?;
    if import.errors.is_empty() { Ok(()) } else { Err(Failure::Told) }
}

/// Returns the columns that the user gives, before those of a template.
fn given_columns(arguments: &ImportArguments) -> Result<Vec<GivenColumn>, Failure> {
    let mut given = arguments.columns.clone();
    if let Some(name) = &arguments.template {
        let template = TemplateFolder::of_user()?.read_template(name)?;
        let kept = template.given_columns().map_err(Failure::Refused)?;
        let is_open = |one: &GivenColumn| given.iter().all(|other| other.header != one.header);
        let open: Vec<GivenColumn> = kept.into_iter().filter(is_open).collect();
        given.extend(open);
    }
    Ok(given)
}

/// Keeps a template, if one is to be kept, and returns notes on it, or on templates that have the
/// columns of a file.
fn template_notes(
    arguments: &ImportArguments,
    guesses: &[ColumnGuess],
) -> Result<Vec<String>, Failure> {
    if let Some(name) = &arguments.save_template {
        let template = ImportTemplate::from_guesses(name, guesses);
        let file = TemplateFolder::of_user()?.write_template(&template)?;
        return Ok(vec![format!("template `{name}` is kept in {}", file.display())]);
    }
    // Without a folder there are no templates.
    let folder = TemplateFolder::of_user().ok().filter(|_| arguments.template.is_none());
    Ok(folder.map_or_else(Vec::new, |folder| folder.matching_notes(guesses)))
}

/// Runs work on a temporary manifest in the folder of the manifest, so that relative paths stay
/// valid.
fn with_draft<T>(
    manifest: &ManifestFile,
    folder: &Path,
    work: impl FnOnce(&Path) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let place = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    // Removed when it is dropped, also after an error.
    let draft = tempfile::Builder::new().prefix(".import").suffix(".yaml").tempfile_in(place);
    let draft = draft.map_err(|error| about_file(place, error))?;
    let text = manifest.to_yaml().map_err(|error| about_file(draft.path(), error))?;
    std::fs::write(draft.path(), text).map_err(|error| about_file(draft.path(), error))?;
    work(draft.path())
}

fn default_manifest(files: &[PathBuf]) -> PathBuf {
    common_folder(files).join("trials.yaml")
}

/// Returns the deepest folder that contains all files.
fn common_folder(files: &[PathBuf]) -> PathBuf {
    let mut folders = files.iter().map(|file| file.parent().unwrap_or(Path::new("")));
    let first = folders.next().unwrap_or(Path::new("")).to_path_buf();
    folders.fold(first, |common, folder| {
        let shared = common.components().zip(folder.components()).take_while(|(a, b)| a == b);
        shared.map(|(part, _)| part).collect()
    })
}

/// Returns the ship's length: as given, or of the ship with that name in the zoo.
fn ship_length(vessel: Option<&Vessel>, arguments: &ImportArguments) -> Option<f64> {
    let known = || vessel?.particulars.get("lpp_m").map(|quantity| quantity.value);
    arguments.length.or_else(known)
}

/// Returns the ship that `--ship` names: one of the zoo, or a file. Another name is only a label.
fn named_vessel(zoo: &Zoo, ship: &str) -> Result<Option<Arc<Vessel>>, Failure> {
    match zoo.vessel(ship) {
        Some(vessel) => Ok(Some(Arc::clone(vessel))),
        None if Path::new(ship).is_file() => vessel_file(zoo, Path::new(ship)).map(Some),
        None => Ok(None),
    }
}

/// Columns that the actuators of a ship name.
fn actuator_columns(vessel: &Vessel) -> impl Iterator<Item = GivenColumn> {
    let channels = vessel.file.actuators.values().flat_map(|actuator| &actuator.channels);
    channels.flat_map(|(channel, headers)| {
        let role = Role::from_name(channel.name());
        let column = move |header: &String| GivenColumn {
            header: header.clone(),
            role,
            unit: None,
            is_reversed: None,
        };
        headers.iter().map(column)
    })
}

fn join_errors(errors: Vec<FileError>) -> Failure {
    let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
    Failure::Refused(lines.join("\n"))
}

/// Returns the trials that are accepted, and the errors of the others.
fn accepted_trials(read: Vec<Result<Trial, Refusal>>) -> (Vec<Trial>, Vec<String>) {
    let (mut trials, mut errors) = (Vec::new(), Vec::new());
    for one in read {
        match one {
            Ok(trial) => trials.push(trial),
            Err(refusal) => errors.extend(
                refusal
                    .findings
                    .iter()
                    .map(|finding| format!("{}: {}", refusal.file, format_finding(finding))),
            ),
        }
    }
    (trials, errors)
}

fn law_needs(zoo: &Zoo, trial: &Trial) -> Vec<LawNeeds> {
    let of = |law: &std::sync::Arc<sistership_model::Law>| LawNeeds {
        law: law.name.clone(),
        lacks: missing_channels(law, trial).iter().map(ToString::to_string).collect(),
    };
    zoo.laws().map(of).collect()
}
