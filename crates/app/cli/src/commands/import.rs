//! `sistership import`: identification of the columns of trial files, and their manifest.

use std::path::{Path, PathBuf};

use clap::Args;
use sistership_model::trial::Trial;
use sistership_model::{FileError, Zoo};
use sistership_trials::{
    ColumnGuess, Exclusion, GivenColumn, LoadedTrials, ManifestFile, ProposalRequest, Role,
    find_faults, load_path, missing_channels, propose_files,
};

use super::import_bundle;
use super::import_log::segment_logs;
use super::import_outcome::{GuessRow, ImportDocument, LawNeeds};
use super::import_template::{ImportTemplate, TemplateFolder, template_name};
use super::import_text;
use super::store::StoreArguments;
use crate::failure::{Failure, about_file};
use crate::files::OutputFile;
use crate::output;
use crate::trials::format_finding;
use crate::values::positive;

const EXAMPLES: &str = "\
Examples:
  sistership import log/*.csv
  sistership import voyage.nmea --ship my-ship --out trials.yaml
  sistership import runs/*/*.csv --column 'Azi=delta:deg:reversed' --explain
  sistership import yard/*.xlsx --column 'Kurs=psi:deg' --save-template yard-x
  sistership import yard/next.xlsx --template yard-x
  sistership import --bundle my-ship.bundle --data-dir sistership-data

Columns are identified by their names (in nine languages), their values and the relations between
them; what was settled by those is said, and where two readings are nearly as likely one question is
asked, with the `--column` that answers it. Faulty values are excluded in the manifest, which may be
edited. It is then used in place of the files: sistership refine --trials trials.yaml

Of a log of many hours the stretches in which rudder or propeller move beyond course keeping become
trials, each with the reason; the table also says what is left, steady course keeping.

Exit status 1 when a file cannot be read, or is refused by the manifest that was written.";

/// Identify the columns of trial files and write a manifest that reads them.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ImportArguments {
    /// Files: CSV and similar text, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, NMEA 0183 and NMEA
    /// 2000 logs, MCAP.
    #[arg(required_unless_present = "bundle")]
    files: Vec<PathBuf>,
    /// Ship of the trials; `refine --ship` may name it instead.
    #[arg(long, value_name = "NAME", default_value = "", hide_default_value = true)]
    ship: String,
    /// Write the manifest to this file; by default `trials.yaml` in the common folder of all files.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Meaning of a column, to answer a question or correct a guess:
    /// HEADER=CHANNEL[:UNIT[:reversed]], nothing after `=` to leave the column out; `#3` is the
    /// third column of a file without a header.
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
    /// Length between perpendiculars, which scales the segmentation of a long log. By default that
    /// of the zoo's ship of this name, or else one that suits the speed.
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
        .ok_or("write HEADER=CHANNEL[:UNIT[:reversed]], or HEADER= to leave the column out")?;
    let mut parts = rest.split(':');
    let name = parts.next().unwrap_or_default().trim();
    let role = match name {
        "" => None,
        name => Some(Role::from_name(name).ok_or_else(|| format!("`{name}` is not a channel"))?),
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
    let out = arguments.out.clone().unwrap_or_else(|| default_manifest(&arguments.files));
    // A manifest may have been edited by hand; only an explicit --out replaces it.
    if arguments.out.is_none() && out.exists() {
        return Err(about_file(&out, "is there already; name another place with --out"));
    }
    let promised = OutputFile::new(&out, &arguments.files)?;
    let files: Vec<&Path> = arguments.files.iter().map(PathBuf::as_path).collect();
    let folder = out.parent().unwrap_or(Path::new(""));
    let given = given_columns(arguments)?;
    let request = ProposalRequest {
        ship: &arguments.ship,
        files: &files,
        folder: Some(folder),
        given: &given,
    };
    let mut proposal = propose_files(&request).map_err(join_errors)?;
    // Segmentation first: faults are then searched only in the segments that become trials.
    let logs = segment_logs(&mut proposal.manifest, folder, ship_length(zoo, arguments));
    let excluded = exclude_faults(&mut proposal.manifest, folder)?;
    let text = proposal.manifest.to_yaml().map_err(|error| about_file(&out, error))?;
    promised.write(text.as_bytes())?;
    let (guesses, mut notes) = (proposal.guesses, proposal.notes);
    notes.extend(template_notes(arguments, &guesses)?);
    let guesses = guesses.into_iter().map(GuessRow::from).collect();
    let explain = arguments.explain;
    let import =
        ImportDocument { logs, notes, guesses, excluded, explain, ..check_manifest(zoo, out)? };
    output::print_result(arguments.json, &import, || import_text::format_import(&import))?;
    if import.errors.is_empty() { Ok(()) } else { Err(Failure::Told) }
}

/// Returns the columns that the user gives, before those of a template.
fn given_columns(arguments: &ImportArguments) -> Result<Vec<GivenColumn>, Failure> {
    let mut given = arguments.columns.clone();
    if let Some(name) = &arguments.template {
        let kept = TemplateFolder::of_user()?.read_template(name)?.given_columns()?;
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

/// Finds faults of the files and excludes them in the manifest. A temporary manifest in the same
/// folder is read, so that relative paths stay valid.
fn exclude_faults(manifest: &mut ManifestFile, folder: &Path) -> Result<Vec<Exclusion>, Failure> {
    let place = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    // Removed when it is dropped, also after an error.
    let draft = tempfile::Builder::new().prefix(".import").suffix(".yaml").tempfile_in(place);
    let draft = draft.map_err(|error| about_file(place, error))?;
    let text = manifest.to_yaml().map_err(|error| about_file(draft.path(), error))?;
    std::fs::write(draft.path(), text).map_err(|error| about_file(draft.path(), error))?;
    let excluded = find_faults(draft.path())?;
    manifest.declarations.exclude.clone_from(&excluded);
    Ok(excluded)
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
fn ship_length(zoo: &Zoo, arguments: &ImportArguments) -> Option<f64> {
    let known =
        || zoo.vessel(&arguments.ship)?.particulars.get("lpp_m").map(|quantity| quantity.value);
    arguments.length.or_else(known)
}

fn join_errors(errors: Vec<FileError>) -> Failure {
    let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
    Failure::Refused(lines.join("\n"))
}

/// Reads the files by the manifest, and checks which laws the trials can identify.
fn check_manifest(zoo: &Zoo, manifest: PathBuf) -> Result<ImportDocument, Failure> {
    let LoadedTrials { trials: read, .. } = load_path(&manifest)?;
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
    // The files of one manifest usually have the same channels: the first trial stands for all.
    let needs = trials.first().map_or_else(Vec::new, |trial| law_needs(zoo, trial));
    let names = trials.into_iter().map(|trial| trial.name).collect();
    Ok(ImportDocument {
        manifest,
        guesses: Vec::new(),
        notes: Vec::new(),
        logs: Vec::new(),
        excluded: Vec::new(),
        trials: names,
        errors,
        lacking: needs,
        explain: false,
    })
}

fn law_needs(zoo: &Zoo, trial: &Trial) -> Vec<LawNeeds> {
    let of = |law: &std::sync::Arc<sistership_model::Law>| LawNeeds {
        law: law.name.clone(),
        lacks: missing_channels(law, trial).iter().map(ToString::to_string).collect(),
    };
    zoo.laws().map(of).collect()
}
