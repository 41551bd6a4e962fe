//! Proposal of a manifest for files: the most likely content of each column, with the evidence.

use std::path::{Component, Path, PathBuf};

use sistership_columns::GivenColumn;
use sistership_model::FileError;
use sistership_model::manifest::{
    Manifest, ManifestTrial, MissingValues, RudderSign, TrialConventions, TrialsKind,
};

use crate::column_set::ColumnSet;
use crate::declarations::{Declarations, Derivable, Maximum, SensorFile};
use crate::file_set::{ClockSpan, FileRole, SetFile, classify_files};
use crate::guess::ColumnGuess;
use crate::manifest_file::ManifestFile;
use crate::preview::{FilePreview, preview_tables};
use crate::sampling::{FileSample, sample_file};
use crate::side_by_side::find_groups;
use crate::thruster_guess::FULL_COMMAND_RPS;

/// Range of seconds since 1970, in the years 2001 to 2065.
const UNIX_S: std::ops::Range<f64> = 1.0e9..3.0e9;

/// Proposed manifest and its evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct ManifestProposal {
    /// Manifest, to be reviewed, completed and stored with the files.
    pub manifest: ManifestFile,
    /// One entry for each column of each file.
    pub guesses: Vec<ColumnGuess>,
    /// Notes on combinations of columns.
    pub notes: Vec<String>,
}

/// Files for which a manifest is to be proposed.
#[derive(Debug, Clone, Copy)]
pub struct ProposalRequest<'a> {
    /// Ship of the trials; empty if it is not known.
    pub ship: &'a str,
    /// Paths of the files.
    pub files: &'a [&'a Path],
    /// Folder of the manifest; by default the common folder of the files.
    pub folder: Option<&'a Path>,
    /// Columns whose content is given by the user.
    pub given: &'a [GivenColumn],
}

/// Proposes a manifest in the folder of the files.
///
/// # Errors
/// Returns the errors of [`propose_files`].
pub fn propose_manifest(ship: &str, files: &[&Path]) -> Result<ManifestProposal, Vec<FileError>> {
    propose_files(&ProposalRequest { ship, files, folder: None, given: &[] })
}

/// Proposes a manifest. Files with the same columns share a mapping. A file with everything that a
/// trial needs becomes a trial, with columns of its own where they differ; other files become
/// sensors of the trial with the largest overlap in time.
///
/// # Errors
/// Returns an error for every file that cannot be read.
pub fn propose_files(request: &ProposalRequest) -> Result<ManifestProposal, Vec<FileError>> {
    let folder = request.folder.map_or_else(|| common_folder(request.files), Path::to_path_buf);
    let mut set = FileSet::default();
    let mut errors = Vec::new();
    for path in request.files {
        let name = relative_path(path, &folder);
        if let Err(error) = set.add_file(&name, path) {
            errors.push(refuse_file(path, &error.to_string()));
        }
    }
    if set.files.is_empty() && errors.is_empty() {
        errors.push(refuse_file(Path::new(""), "give at least one file"));
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    // Columns are identified once all files with the same columns have contributed their samples.
    set.shapes.iter_mut().for_each(|shape| shape.identify_all(request.given));
    set.settle_spans();
    Ok(set.into_proposal(request.ship))
}

/// Returns the channels that must be derived where a file, or files together, have others.
fn derivable_channels(one: &dyn Fn(&str) -> bool) -> Vec<Derivable> {
    let has = |names: &[&str]| names.iter().all(|name| one(name));
    let track = has(&["psi"]) && (has(&["x", "y"]) || has(&["latitude", "longitude"]));
    // Course and speed, or velocities north and east, give `u` and `v` without derivation.
    let ground = has(&["course", "speed", "psi"]) || has(&["v_north", "v_east", "psi"]);
    let open = [
        ("u", Derivable::U, track && !ground),
        ("v", Derivable::V, track && !ground),
        ("r", Derivable::R, has(&["psi"])),
    ];
    let missing = open.into_iter().filter(|(name, _, is_known)| *is_known && !one(name));
    missing.map(|(_, channel, _)| channel).collect()
}

fn several_trials(groups: &[Vec<&str>]) -> String {
    let columns: Vec<String> = groups.iter().map(|group| group.join(", ")).collect();
    format!(
        "it holds {} trials side by side, each with its own time ({}); save each as a file, or a \
         sheet of a workbook, of its own",
        groups.len(),
        columns.join("; ")
    )
}

fn refuse_file(path: &Path, message: &str) -> FileError {
    FileError {
        file: path.display().to_string(),
        line: None,
        field: String::new(),
        message: message.to_owned(),
        further: Vec::new(),
    }
}

/// Returns the deepest folder that contains all files.
fn common_folder(files: &[&Path]) -> PathBuf {
    let parent = |path: &&Path| path.parent().unwrap_or(Path::new("")).to_path_buf();
    let mut folders = files.iter().map(parent);
    let first = folders.next().unwrap_or_default();
    folders.fold(first, |common, folder| {
        let shared = common.components().zip(folder.components()).take_while(|(a, b)| a == b);
        shared.map(|(part, _)| part).collect()
    })
}

/// Returns a path relative to a folder, with `/` between its parts.
fn relative_path(path: &Path, folder: &Path) -> String {
    let here = |path: &Path| if path.as_os_str().is_empty() { ".".into() } else { path.to_owned() };
    // Absolute paths, so that both have a common root.
    let plain = |path: &Path| std::path::absolute(here(path)).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (plain(path), plain(folder));
    let same = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(same).filter(|part| *part != Component::CurDir);
    let down = path.components().skip(same);
    let parts = up
        .map(|_| "..".to_owned())
        .chain(down.map(|part| part.as_os_str().to_string_lossy().into_owned()));
    parts.collect::<Vec<_>>().join("/")
}

/// Files and their column sets.
#[derive(Default)]
struct FileSet {
    files: Vec<SetFile>,
    shapes: Vec<ColumnSet>,
    /// Sample of each file, until the unit of its time is known.
    samples: Vec<FileSample>,
}

impl FileSet {
    fn add_file(&mut self, name: &str, path: &Path) -> std::io::Result<()> {
        for preview in preview_tables(name, path)? {
            self.add_table(name, path, preview)?;
        }
        Ok(())
    }

    fn add_table(&mut self, name: &str, path: &Path, preview: FilePreview) -> std::io::Result<()> {
        if let Some(groups) = find_groups(&preview.names) {
            return Err(std::io::Error::other(several_trials(&groups)));
        }
        // NMEA sentences are identified by their names, without a sample.
        let sample = match preview.sentences.is_empty() {
            true => sample_file(name, path, &preview)?,
            false => FileSample::default(),
        };
        let known = self.shapes.iter().position(|shape| shape.matches_preview(&preview));
        let shape = known.unwrap_or_else(|| {
            self.shapes.push(ColumnSet::new(&preview));
            self.shapes.len() - 1
        });
        self.shapes[shape].add_sample(&sample.recording);
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        let name = match &preview.part {
            Some(part) => format!("{name}#part={part}"),
            None => name.to_owned(),
        };
        self.files.push(SetFile { name, folder, shape, span: None });
        self.samples.push(sample);
        Ok(())
    }

    /// Computes the first and last time of each file, once its time column and unit are known.
    fn settle_spans(&mut self) {
        for (file, sample) in self.files.iter_mut().zip(self.samples.drain(..)) {
            let Some((at, factor)) = self.shapes[file.shape].time else { continue };
            let Some(column) = sample.recording.columns.get(at) else { continue };
            let start = sample.start.as_ref().filter(|start| start.dated);
            let from = start.map_or(0.0, |start| start.at_s);
            let values = column.values.iter().filter(|value| value.is_finite());
            let ends = (values.clone().next(), values.clone().next_back());
            if let (Some(first), Some(last)) = ends {
                let (from_s, to_s) = (from + first * factor, from + last * factor);
                let is_dated = start.is_some() || UNIX_S.contains(&from_s);
                file.span = Some(ClockSpan { from_s, to_s, is_dated });
            }
        }
    }

    fn into_proposal(mut self, ship: &str) -> ManifestProposal {
        let parts = classify_files(&self.files, &self.shapes);
        // Before columns are cloned: a common sign replaces the reversal of single columns.
        let rudder = self.common_rudder_sign();
        let places: Vec<usize> =
            (0..parts.len()).filter(|&k| parts[k] == FileRole::Trial).collect();
        // The columns of the first trial become those of the manifest; others are listed at their
        // trial.
        let first = places.first().map_or(0, |&at| self.files[at].shape);
        let columns = self.shapes[first].columns.clone();
        let trials: Vec<ManifestTrial> =
            places.iter().map(|&at| self.manifest_trial(at, first)).collect();
        let sensors = places.iter().map(|&at| self.sensor_files(at, &parts)).collect();
        let conventions = TrialConventions {
            missing: MissingValues::Bridge,
            rudder_positive: rudder,
            ..TrialConventions::default()
        };
        let manifest = Manifest {
            kind: TrialsKind::Trials,
            ship: ship.to_owned(),
            conventions,
            columns,
            trials,
        };
        let declarations = self.proposed_declarations();
        let notes = self.shapes.iter().flat_map(|shape| shape.notes.clone()).collect();
        let guesses = self.column_guesses();
        ManifestProposal {
            manifest: ManifestFile { manifest, declarations, sensors },
            guesses,
            notes,
        }
    }

    /// Returns the sign of the rudder if all files agree; single columns then need no reversal.
    fn common_rudder_sign(&mut self) -> RudderSign {
        let mut signs = self.shapes.iter().filter_map(ColumnSet::is_rudder_reversed).peekable();
        let all = signs.peek().is_some() && signs.all(|reversed| reversed);
        if !all {
            return RudderSign::StarboardTurn;
        }
        for shape in &mut self.shapes {
            for name in ["delta", "delta_s", "delta_p"] {
                shape.columns.get_mut(name).into_iter().for_each(|one| one.reversed = false);
            }
        }
        RudderSign::PortTurn
    }

    fn manifest_trial(&self, at: usize, first: usize) -> ManifestTrial {
        let file = &self.files[at];
        let columns = match file.shape == first {
            true => indexmap::IndexMap::default(),
            false => self.shapes[file.shape].columns.clone(),
        };
        ManifestTrial { columns, ..ManifestTrial::from_file_name(&file.name) }
    }

    fn sensor_files(&self, trial: usize, parts: &[FileRole]) -> Vec<SensorFile> {
        let of_trial =
            self.files.iter().zip(parts).filter(|(_, part)| **part == FileRole::SensorOf(trial));
        let sensor = |file: &SetFile| {
            let shape = &self.shapes[file.shape];
            let trial = &self.shapes[self.files[trial].shape];
            // Channels that the trial has itself are not read from the sensor.
            let own =
                shape.columns.iter().filter(|(name, _)| *name == "t" || !trial.has_channel(name));
            SensorFile {
                file: file.name.clone(),
                columns: own.map(|(name, column)| (name.clone(), column.clone())).collect(),
                clock_offset_s: None,
            }
        };
        of_trial.map(|(file, _)| sensor(file)).collect()
    }

    /// Returns the identified content of each column of each file.
    fn column_guesses(&self) -> Vec<ColumnGuess> {
        let of_file = |file: &SetFile| {
            let each = self.shapes[file.shape].guesses.iter();
            each.map(|guess| ColumnGuess { file: file.name.clone(), ..guess.clone() })
                .collect::<Vec<_>>()
        };
        self.files.iter().flat_map(of_file).collect()
    }

    /// Returns the columns to ignore, and the velocities to derive where positions and heading
    /// exist and velocities do not.
    fn proposed_declarations(&self) -> Declarations {
        // A file that is a trial by itself has no channels of other files; sensors share theirs.
        let complete = self.shapes.iter().filter(|shape| shape.is_complete());
        let mut derive: Vec<Derivable> = complete
            .flat_map(|shape| derivable_channels(&|name| shape.has_channel(name)))
            .collect();
        let any = |name: &str| self.shapes.iter().any(|shape| shape.has_channel(name));
        derive.extend(derivable_channels(&any));
        let order = [Derivable::U, Derivable::V, Derivable::R];
        let derive = order.into_iter().filter(|one| derive.contains(one)).collect();
        let guesses = self.shapes.iter().flat_map(|shape| &shape.guesses);
        let left = guesses.filter(|guess| guess.channel.is_none() && !guess.column.is_empty());
        let mut ignore: Vec<String> = left.map(|guess| guess.column.clone()).collect();
        ignore.sort_unstable();
        ignore.dedup();
        let full = Maximum { value: FULL_COMMAND_RPS, unit: "rps".to_owned() };
        let commands = self.shapes.iter().any(|shape| shape.has_commands);
        let maximum = commands.then(|| ("n".to_owned(), full)).into_iter().collect();
        Declarations { derive, ignore, maximum, ..Declarations::default() }
    }
}

#[cfg(test)]
#[path = "propose_tests.rs"]
mod tests;
