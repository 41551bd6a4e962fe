//! Reading of a path of the command line: a manifest, or one file.

use std::io;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use sistership_model::FileError;
use sistership_model::manifest::{Manifest, split_part};
use sistership_model::trial::{Finding, Trial};

use crate::declarations::SensorFile;
use crate::exclusion::Exclusion;
use crate::manifest::read_local_manifest;
use crate::mapping::{FaultHandling, Mapping};
use crate::outcome::{CheckOutcome, Refusal};
use crate::read::{CheckedRecording, SegmentRequest, examine_source, read_segments};
use crate::trial_file::TrialFile;

/// Trials read from a path, with the manifest.
#[derive(Debug)]
pub struct LoadedTrials {
    /// The manifest, if the path named one.
    pub manifest: Option<Manifest>,
    /// Trial of each file, in the order of the manifest.
    pub trials: Vec<Result<Trial, Refusal>>,
}

/// Reads a manifest (`.yaml`, `.yml`, `.json`) with all its files, or a CSV or Parquet file with canonical
/// column names.
///
/// # Errors
/// Returns an error if the manifest is invalid or the path cannot be read. A single trial that is
/// refused is no error of the whole.
pub fn load_path(path: &Path) -> Result<LoadedTrials, FileError> {
    let (manifest, mut trials) =
        read_each(path, FaultHandling::Ignore, |name, examined| match examined {
            Ok(examined) => examined.into_trial(name),
            Err(error) => Err(Refusal { file: name, findings: vec![unreadable_finding(&error)] }),
        })?;
    if manifest.is_none()
        && let (Some(Ok(trial)), Some(name)) = (trials.first_mut(), path.file_name())
    {
        // The folder of the file on this machine must not become part of the recipe of a version.
        trial.name = name.to_string_lossy().into_owned();
    }
    Ok(LoadedTrials { manifest, trials })
}

/// Checks the files that [`load_path`] would read, and returns the outcomes only.
///
/// # Errors
/// Returns the errors of [`load_path`].
pub fn check_path(path: &Path) -> Result<Vec<CheckOutcome>, FileError> {
    let outcomes = read_each(path, FaultHandling::Report, |name, examined| match examined {
        Ok(examined) => examined.into_outcome(name),
        Err(error) => CheckOutcome {
            file: name,
            rows: 0,
            duration_s: 0.0,
            errors: vec![unreadable_finding(&error)],
            warnings: Vec::new(),
        },
    })?;
    Ok(outcomes.1)
}

/// Trials read from a manifest without the faults of their values.
#[derive(Debug)]
pub struct CleanedTrials {
    /// Trial of each entry, in the order of the manifest.
    pub trials: Vec<Result<Trial, Refusal>>,
    /// Faults that the manifest does not exclude yet, by file and channel.
    pub excluded: Vec<Exclusion>,
}

/// Reads the trials of a manifest, and excludes faults of their values.
///
/// # Errors
/// Returns the errors of [`load_path`].
pub fn load_cleaned(path: &Path) -> Result<CleanedTrials, FileError> {
    let (manifest, read) =
        read_each(path, FaultHandling::Exclude, |name, examined| match examined {
            Ok(mut examined) => (examined.take_faults(), examined.into_trial(name)),
            Err(error) => {
                let findings = vec![unreadable_finding(&error)];
                (Vec::new(), Err(Refusal { file: name, findings }))
            }
        })?;
    let (found, trials): (Vec<Vec<Exclusion>>, Vec<_>) = read.into_iter().unzip();
    let files = manifest.iter().flat_map(|manifest| &manifest.trials).map(|trial| &trial.file);
    let mut excluded: Vec<Exclusion> = Vec::new();
    for (file, fault) in
        files.zip(found).flat_map(|(file, all)| all.into_iter().map(move |one| (file, one)))
    {
        let fault = Exclusion { file: file.clone(), ..fault };
        // Segments of one file are checked separately; faults of the same kind become one entry.
        match excluded.iter_mut().find(|one| one.is_like(&fault)) {
            Some(known) => known.add_rows(&fault),
            None => excluded.push(fault),
        }
    }
    Ok(CleanedTrials { trials, excluded })
}

/// File to be read, and the files of sensors that belong to it.
struct ListedFile {
    name: String,
    path: PathBuf,
    mapping: Mapping,
    sensors: Vec<(SensorFile, PathBuf)>,
}

impl ListedFile {
    fn open(&self) -> io::Result<TrialFile<'static>> {
        TrialFile::open_trial(&self.name, &self.path, &self.mapping, &self.sensors)
    }

    /// Returns true if both are segments of one file, which is then read once.
    fn shares_file(&self, other: &Self) -> bool {
        let both = self.mapping.stretch.is_some() && other.mapping.stretch.is_some();
        // Sheets of one workbook are tables of their own.
        let same = self.mapping.part == other.mapping.part;
        both && same && self.path.components().eq(other.path.components())
    }
}

/// Applies `take` to each trial of a path, and returns the results in the order of the manifest;
/// files are read in parallel.
fn read_each<T: Send>(
    path: &Path,
    faults: FaultHandling,
    take: impl Fn(String, io::Result<CheckedRecording>) -> T + Sync,
) -> Result<(Option<Manifest>, Vec<T>), FileError> {
    let (manifest, mut listed) = list_files(path)?;
    listed.iter_mut().for_each(|one| one.mapping.faults = faults);
    Ok((manifest, examine_each(&listed, take)))
}

fn examine_each<T: Send>(
    listed: &[ListedFile],
    take: impl Fn(String, io::Result<CheckedRecording>) -> T + Sync,
) -> Vec<T> {
    let taken = |places: Vec<usize>| -> Vec<(usize, T)> {
        let group: Vec<&ListedFile> = places.iter().map(|&k| &listed[k]).collect();
        let each = places.iter().zip(examine_group(&group));
        each.map(|(&k, examined)| (k, take(listed[k].name.clone(), examined))).collect()
    };
    // One task per file (`with_max_len`), since files differ in size; sorted again afterwards so
    // that the result does not depend on the order of completion.
    let mut all: Vec<(usize, T)> =
        group_by_file(listed).into_par_iter().with_max_len(1).flat_map_iter(taken).collect();
    all.sort_by_key(|(place, _)| *place);
    all.into_iter().map(|(_, taken)| taken).collect()
}

/// Groups the indices of segments that are read in one pass.
fn group_by_file(listed: &[ListedFile]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (place, this) in listed.iter().enumerate() {
        match groups.iter_mut().find(|group| listed[group[0]].shares_file(this)) {
            Some(group) => group.push(place),
            None => groups.push(vec![place]),
        }
    }
    groups
}

/// Reads and checks one file, or several segments of one file in one pass.
fn examine_group(group: &[&ListedFile]) -> Vec<io::Result<CheckedRecording>> {
    // A single entry needs no distribution of rows.
    if let [alone] = group {
        return vec![alone.open().map(|source| examine_source(source, &alone.mapping))];
    }
    let sources: io::Result<Vec<TrialFile>> = group.iter().map(|listed| listed.open()).collect();
    let mut sources = match sources {
        Ok(sources) => sources.into_iter(),
        Err(error) => {
            // `io::Error` cannot be cloned: each segment gets a copy of kind and message.
            let told = |_: &&ListedFile| Err(io::Error::new(error.kind(), error.to_string()));
            return group.iter().map(told).collect();
        }
    };
    let Some(TrialFile { content, sensors, .. }) = sources.next() else { return Vec::new() };
    let sensors = std::iter::once(sensors).chain(sources.map(|source| source.sensors));
    let requests = group.iter().zip(sensors).map(|(listed, sensors)| SegmentRequest {
        name: &listed.name,
        mapping: &listed.mapping,
        sensors,
    });
    read_segments(content, requests.collect()).into_iter().map(Ok).collect()
}

/// Returns the files named by a path: those of a manifest, or the file itself.
fn list_files(path: &Path) -> Result<(Option<Manifest>, Vec<ListedFile>), FileError> {
    let shown = path.display().to_string();
    if !is_manifest(path) {
        let (file, part) = split_path(path);
        std::fs::metadata(&file).map_err(|error| unreadable_file(&shown, &error))?;
        let (mapping, sensors) = (Mapping { part, ..Mapping::with_canonical_names() }, Vec::new());
        let alone = ListedFile { name: shown, path: file, mapping, sensors };
        return Ok((None, vec![alone]));
    }
    let text = std::fs::read_to_string(path).map_err(|error| unreadable_file(&shown, &error))?;
    let written = read_local_manifest(&shown, &text)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let listed =
        written.manifest.trials.iter().zip(&written.sensors).map(|(trial, sensors)| ListedFile {
            name: trial.trial_label(),
            path: folder.join(trial.file_path()),
            mapping: written.trial_mapping(trial),
            sensors: sensors
                .iter()
                .map(|one| (one.clone(), folder.join(one.file_path())))
                .collect(),
        });
    let listed = listed.collect();
    Ok((Some(written.manifest), listed))
}

/// Separates a file from the part that is named behind it, `log.xlsx#part=NAME`, unless there is a
/// file of that whole name.
pub fn split_path(path: &Path) -> (PathBuf, Option<String>) {
    let shown = path.display().to_string();
    match split_part(&shown) {
        (file, Some(part)) if !path.exists() => (PathBuf::from(file), Some(part.to_owned())),
        _ => (path.to_owned(), None),
    }
}

/// Returns true for the endings of YAML, and of JSON, which is YAML as well.
fn is_manifest(path: &Path) -> bool {
    let is_ending = |ending: &std::ffi::OsStr| {
        ["yaml", "yml", "json"].iter().any(|known| ending.eq_ignore_ascii_case(known))
    };
    path.extension().is_some_and(is_ending)
}

fn unreadable_file(file: &str, error: &io::Error) -> FileError {
    FileError {
        file: file.to_owned(),
        line: None,
        field: String::new(),
        message: format!("cannot be read: {error}"),
        further: Vec::new(),
    }
}

fn unreadable_finding(error: &io::Error) -> Finding {
    Finding { row: None, column: None, message: format!("cannot be read: {error}") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const MANIFEST: &str = "kind: trials\nship: a\ncolumns: { u: { column: log, unit: kn } }\n\
                            trials: [{ file: a.csv, manoeuvre: zigzag 10/10 }, { file: lost.csv \
                            }]\n";

    #[test]
    fn a_manifest_gives_each_file_its_own_outcome() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("m.yaml"), MANIFEST).unwrap();
        std::fs::write(folder.path().join("a.csv"), "t_s,log\n0,1\n1,2\n2,3\n").unwrap();
        let loaded = load_path(&folder.path().join("m.yaml")).unwrap();
        assert_eq!(loaded.manifest.unwrap().ship, "a");
        assert_eq!(loaded.trials[0].as_ref().unwrap().manoeuvre.as_deref(), Some("zigzag 10/10"));
        assert!(
            loaded.trials[1]
                .as_ref()
                .unwrap_err()
                .to_string()
                .contains("lost.csv is refused:\n  cannot be read")
        );
        let outcomes = check_path(&folder.path().join("m.yaml")).unwrap();
        assert_eq!(
            outcomes.iter().map(CheckOutcome::is_accepted).collect::<Vec<_>>(),
            [true, false]
        );
    }

    #[test]
    fn a_manifest_in_json_is_a_manifest() {
        let folder = tempfile::tempdir().unwrap();
        let manifest = folder.path().join("m.json");
        let text = r#"{"kind": "trials", "ship": "a", "trials": [{"file": "a.csv"}]}"#;
        std::fs::write(&manifest, text).unwrap();
        std::fs::write(folder.path().join("a.csv"), "t_s,u_m_s\n0,1\n1,2\n2,3\n").unwrap();
        let loaded = load_path(&manifest).unwrap();
        assert_eq!(loaded.manifest.unwrap().ship, "a");
        assert_eq!(loaded.trials[0].as_ref().unwrap().len(), 3);
    }

    #[test]
    fn sensors_files_are_read_into_one_trial() {
        let folder = tempfile::tempdir().unwrap();
        let manifest = "kind: trials\nship: a\ntrials:\n  - file: a.csv\n    sensors:\n      \
                        - { file: b.csv, columns: { psi: { column: hdg, unit: deg } }, \
                        clock_offset_s: 0.5 }\n";
        std::fs::write(folder.path().join("m.yaml"), manifest).unwrap();
        std::fs::write(folder.path().join("a.csv"), "t_s,u_m_s\n1,1\n2,2\n3,3\n4,5\n").unwrap();
        let heading = "t_s,hdg,note\n0.5,350,a\n1.5,0,b\n2.5,10,c\n3.5,20,d\n";
        std::fs::write(folder.path().join("b.csv"), heading).unwrap();
        let loaded = load_path(&folder.path().join("m.yaml")).unwrap();
        let trial = loaded.trials[0].as_ref().unwrap();
        let psi = trial.channel(sistership_model::trial::Channel::Psi).unwrap();
        assert!((psi[3] - psi[0] - 30.0_f64.to_radians()).abs() < 1e-12, "{psi:?}");
        assert!(trial.warnings.iter().any(|told| told.message == "b.csv: columns not read: note"));
    }

    #[test]
    fn a_file_is_read_without_a_manifest() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        std::fs::write(&file, "t_s,u_m_s\n0,1\n1,2\n2,3\n").unwrap();
        let loaded = load_path(&file).unwrap();
        let trial = loaded.trials[0].as_ref().unwrap();
        assert_eq!((trial.name.as_str(), trial.len()), ("a.csv", 3));
        assert!(
            load_path(&folder.path().join("lost.csv"))
                .unwrap_err()
                .to_string()
                .contains("cannot be read")
        );
    }
}
