//! A manifest proposed for files: what each column most likely is, and why.

use std::path::Path;

use indexmap::IndexMap;
use sistership_model::FileError;
use sistership_model::manifest::{
    ColumnMapping, Manifest, ManifestTrial, Missing, TrialConventions, TrialsKind,
};

use crate::declarations::{Declarations, Derivable, SensorFile};
use crate::manifest_file::ManifestFile;
use crate::preview::{Preview, preview};
use crate::table::Target;
use crate::unit_guess::{UnitGuess, unit};
use crate::units::Kind;
use crate::vocabulary::likely;

/// A manifest and what it rests on.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// To be read over, completed and kept beside the files.
    pub manifest: ManifestFile,
    /// One for each column of each file.
    pub guesses: Vec<Guess>,
}

/// What a column was taken for.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    /// The file, as it was named.
    pub file: String,
    /// The column's header.
    pub column: String,
    /// The channel's name in manifests; absent for a column that is left out.
    pub channel: Option<String>,
    /// Its unit.
    pub unit: Option<String>,
    /// Why.
    pub why: String,
    /// Whether header and unit say so themselves; otherwise someone should look.
    pub certain: bool,
}

/// Proposes a manifest for files in one folder. Files with the columns of the first are trials of
/// their own; files with others are taken for further sensors of the trial that shares most parts
/// of their name, as `rudder_2.csv` does with `motion_2.csv`, else of the first.
///
/// # Errors
/// Every file that cannot be read, and why.
pub fn propose(ship: &str, files: &[&Path]) -> Result<Proposal, Vec<FileError>> {
    let mut seen = Vec::new();
    let mut errors = Vec::new();
    for path in files {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        match preview(&name, path) {
            Ok(preview) => seen.push(Seen::of(name, preview)),
            Err(error) => errors.push(refused(path, &error.to_string())),
        }
    }
    if seen.is_empty() && errors.is_empty() {
        errors.push(refused(Path::new(""), "no file is named"));
    }
    if errors.is_empty() { Ok(proposal(ship, seen)) } else { Err(errors) }
}

fn refused(path: &Path, message: &str) -> FileError {
    FileError {
        file: path.display().to_string(),
        line: None,
        field: String::new(),
        message: message.to_owned(),
        further: Vec::new(),
    }
}

/// A file and what its columns were taken for.
struct Seen {
    file: String,
    preview: Preview,
    columns: IndexMap<String, ColumnMapping>,
    guesses: Vec<Guess>,
}

impl Seen {
    fn of(file: String, preview: Preview) -> Self {
        let mut seen = Self { file, preview, columns: IndexMap::new(), guesses: Vec::new() };
        seen.guesses.extend(seen.preview.sentences.iter().map(|(name, target)| Guess {
            file: seen.file.clone(),
            column: name.clone(),
            channel: Some(target.name().to_owned()),
            unit: Some(Kind::of(*target).canonical().to_owned()),
            why: "NMEA 0183 says what the sentence holds; it needs no mapping".into(),
            certain: true,
        }));
        for index in 0..seen.preview.names.len() {
            let guess = seen.guess(index);
            if let (Some(channel), Some(unit)) = (&guess.channel, &guess.unit) {
                let mapped = ColumnMapping { column: guess.column.clone(), unit: unit.clone() };
                seen.columns.insert(channel.clone(), mapped);
            }
            seen.guesses.push(guess);
        }
        seen
    }

    fn guess(&self, index: usize) -> Guess {
        let column = self.preview.names[index].clone();
        let nothing = |why: String| Guess {
            file: self.file.clone(),
            column: column.clone(),
            channel: None,
            unit: None,
            why,
            certain: false,
        };
        let canonical = crate::names::canonical(&column);
        let (target, exact) = match (&canonical, likely(&column)) {
            (Some((target, _)), _) => (*target, true),
            (None, Some(likely)) => match Target::by_name(likely.target) {
                Some(target) => (target, likely.exact),
                None => return nothing("no known name of a channel; left out".into()),
            },
            _ => return nothing("no known name of a channel; left out".into()),
        };
        let name = target.name();
        if let Some(first) = self.columns.get(name) {
            return nothing(format!("`{}` is taken for {name} already; left out", first.column));
        }
        let cells: Vec<&str> =
            self.preview.rows.iter().filter_map(|row| row.get(index)).map(String::as_str).collect();
        if !self.preview.rows.is_empty() && cells.iter().all(|cell| cell.is_empty()) {
            return nothing("empty in the first rows; left out".into());
        }
        let below = self.preview.units.get(index).map(String::as_str);
        let UnitGuess { unit, why, certain } = unit(target, &column, below, &cells);
        let how = if exact { "is a name of" } else { "contains a name of" };
        Guess {
            file: self.file.clone(),
            column,
            channel: Some(name.to_owned()),
            unit: Some(unit),
            why: format!("the header {how} {name}; {why}"),
            certain: exact && certain,
        }
    }

    fn has(&self, names: &[&str]) -> bool {
        let told = |name: &str| self.preview.sentences.iter().any(|(_, held)| held.name() == name);
        names.iter().all(|name| self.columns.contains_key(*name) || told(name))
    }
}

fn proposal(ship: &str, seen: Vec<Seen>) -> Proposal {
    let (mut trials, mut further, mut guesses) = (Vec::new(), Vec::new(), Vec::new());
    let (columns, mut declarations) = match seen.first() {
        Some(first) => (first.columns.clone(), declarations(&seen)),
        None => Default::default(),
    };
    for (at, one) in seen.into_iter().enumerate() {
        if at == 0 || one.columns == columns {
            trials.push(ManifestTrial::of(one.file));
        } else {
            let columns = one.columns.into_iter().collect();
            further.push(SensorFile { file: one.file, columns, clock_offset_s: None });
        }
        declarations.sheet = declarations.sheet.or(one.preview.sheet);
        guesses.extend(one.guesses);
    }
    let mut sensors = vec![Vec::new(); trials.len().max(1)];
    for sensor in further {
        sensors[trial_of(&sensor.file, &trials)].push(sensor);
    }
    let manifest = Manifest {
        kind: TrialsKind::Trials,
        ship: ship.to_owned(),
        // A row without time or state is no sample; that it was left out is said, and gaps stay
        // gaps.
        conventions: TrialConventions { missing: Missing::Drop, ..TrialConventions::default() },
        columns,
        trials,
    };
    Proposal { manifest: ManifestFile { manifest, declarations, sensors }, guesses }
}

/// The place of the trial whose file shares most parts of its name with a sensor's.
fn trial_of(sensor: &str, trials: &[ManifestTrial]) -> usize {
    let parts = name_parts(sensor);
    let shared = |trial: &ManifestTrial| {
        name_parts(&trial.file).iter().filter(|part| parts.contains(part)).count()
    };
    let places = trials.iter().enumerate().map(|(place, trial)| (place, shared(trial)));
    places.rev().max_by_key(|(_, count)| *count).map_or(0, |(place, _)| place)
}

/// Runs of letters and of digits of a file's name without its ending.
fn name_parts(file: &str) -> Vec<String> {
    let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let mut parts: Vec<String> = Vec::new();
    let mut last = None;
    for letter in stem.chars() {
        let kind = letter.is_alphanumeric().then(|| letter.is_numeric());
        match (kind == last, kind) {
            (true, Some(_)) => parts.last_mut().into_iter().for_each(|part| part.push(letter)),
            (false, Some(_)) => parts.push(letter.to_string()),
            (_, None) => {}
        }
        last = kind;
    }
    parts
}

/// Columns to pass over, and velocities to derive where positions and heading are there and they
/// are not.
fn declarations(seen: &[Seen]) -> Declarations {
    let has = |names: &[&str]| names.iter().all(|name| seen.iter().any(|one| one.has(&[name])));
    let track = has(&["psi"]) && (has(&["x", "y"]) || has(&["latitude", "longitude"]));
    let ground = has(&["course", "speed", "psi"]);
    let mut derive = Vec::new();
    if track && !ground {
        let open = [("u", Derivable::U), ("v", Derivable::V)];
        derive.extend(open.into_iter().filter(|(name, _)| !has(&[name])).map(|(_, one)| one));
    }
    if has(&["psi"]) && !has(&["r"]) {
        derive.push(Derivable::R);
    }
    let mut ignore: Vec<String> = seen
        .iter()
        .flat_map(|one| &one.guesses)
        .filter(|guess| guess.channel.is_none() && !guess.column.is_empty())
        .map(|guess| guess.column.clone())
        .collect();
    ignore.sort_unstable();
    ignore.dedup();
    Declarations { derive, ignore, ..Declarations::default() }
}

#[cfg(test)]
#[path = "propose_tests.rs"]
mod tests;
