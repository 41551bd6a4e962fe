//! Trials that a command reads: all files or none, each under a unique name.

use std::path::{Path, PathBuf};

use sistership_model::trial::{Finding, Trial};
use sistership_trials::{LoadedTrials, load_path, split_path};

use crate::failure::Failure;
use crate::output::{format_count, print_note};

/// Number of warnings of a file that are printed; the rest is counted.
const MAX_PRINTED_WARNINGS: usize = 3;

/// Trial with its origin.
#[derive(Debug)]
pub struct ReadTrial {
    /// The trial.
    pub trial: Trial,
    /// The file as the command line or the manifest names it.
    pub file: String,
    /// The file's path.
    pub path: PathBuf,
    /// True if it is a segment of its file, or a sheet of it.
    pub is_stretch: bool,
    /// The ship that the manifest names.
    pub ship: Option<String>,
}

/// Reads every file; warnings go to standard error.
///
/// # Errors
/// Returns an error with all refusals, by row and column.
pub fn read_trials(paths: &[PathBuf]) -> Result<Vec<ReadTrial>, Failure> {
    let (mut read, mut refused) = (Vec::new(), Vec::new());
    let mut recordings: Vec<PathBuf> = Vec::new();
    for path in paths {
        let loaded = match load_path(path) {
            Ok(loaded) => loaded,
            Err(error) => {
                refused.push(error.to_string());
                continue;
            }
        };
        // Every file is read, so that all faults are reported in one run.
        let files = files_of(path, &loaded);
        let is_recording = loaded.manifest.is_none();
        let named = |ship: &String| !ship.is_empty();
        let ship = loaded.manifest.map(|manifest| manifest.ship).filter(named);
        for (result, (file, path, is_stretch)) in loaded.trials.into_iter().zip(files) {
            match result {
                Ok(trial) => {
                    read.push(ReadTrial { trial, file, path, is_stretch, ship: ship.clone() });
                }
                Err(refusal) => {
                    refused.push(refusal.to_string());
                    recordings.extend(Some(path).filter(|_| is_recording));
                }
            }
        }
    }
    if !refused.is_empty() {
        refused.extend(import_hint(&recordings));
        return Err(Failure::Refused(refused.join("\n")));
    }
    print_warnings(&read);
    make_names_unique(&mut read)?;
    Ok(read)
}

/// Advice on recordings that are read without a manifest; `None` if there is none.
fn import_hint(recordings: &[PathBuf]) -> Option<String> {
    let (first, _) = split_path(recordings.first()?);
    let first = first.display();
    let more = if recordings.len() > 1 { " ..." } else { "" };
    Some(format!(
        "`sistership import {first}{more}` identifies the columns and units of a recording and \
         writes a manifest, which this command reads in place of it"
    ))
}

fn files_of(path: &Path, loaded: &LoadedTrials) -> Vec<(String, PathBuf, bool)> {
    let folder = path.parent().unwrap_or(Path::new(""));
    match &loaded.manifest {
        Some(manifest) => manifest
            .trials
            .iter()
            .map(|trial| {
                // A sheet is a part of its workbook, as a segment is of a log.
                let is_part = trial.is_segment() || trial.file_path() != trial.file;
                (trial.trial_label(), folder.join(trial.file_path()), is_part)
            })
            .collect(),
        None => {
            let (file, part) = split_path(path);
            vec![(path.display().to_string(), file, part.is_some())]
        }
    }
}

/// Prints the first warnings of each file; a warning that several files share is printed once.
fn print_warnings(read: &[ReadTrial]) {
    let mut told: Vec<(String, &str, usize)> = Vec::new();
    for read in read {
        let warnings = &read.trial.warnings;
        let more = warnings.len().saturating_sub(MAX_PRINTED_WARNINGS);
        let further = (more > 0).then(|| {
            format!("{}; `sistership check` lists them", format_count(more, "further warning"))
        });
        for message in warnings.iter().take(MAX_PRINTED_WARNINGS).map(format_finding).chain(further)
        {
            match told.iter_mut().find(|(known, ..)| *known == message) {
                Some((.., others)) => *others += 1,
                None => told.push((message, &read.file, 0)),
            }
        }
    }
    for (message, file, others) in told {
        let others = if others > 0 {
            format!(" and {}", format_count(others, "other"))
        } else {
            String::new()
        };
        print_note(&format!("warning: {file}{others}: {message}"));
    }
}

/// Formats a finding with its row and column.
pub fn format_finding(finding: &Finding) -> String {
    let row = finding.row.map_or(String::new(), |row| format!("row {row}: "));
    let column =
        finding.column.as_ref().map_or(String::new(), |column| format!("column `{column}`: "));
    format!("{row}{column}{}", finding.message)
}

/// Makes names unique by the folder of the file; refuses a file that is given twice, because its
/// data would count twice.
fn make_names_unique(read: &mut [ReadTrial]) -> Result<(), Failure> {
    for index in 1..read.len() {
        let (earlier, rest) = read.split_at_mut(index);
        let this = &mut rest[0];
        let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        // The reader has checked that segments of one file do not overlap.
        let is_apart = |other: &ReadTrial| {
            other.is_stretch && this.is_stretch && other.trial.name != this.trial.name
        };
        let is_same = |other: &ReadTrial| real(&other.path) == real(&this.path);
        if earlier.iter().any(|other| is_same(other) && !is_apart(other)) {
            return Err(Failure::Refused(format!(
                "{}: is listed twice, so that its data would count twice; list it once",
                this.file
            )));
        }
        if earlier.iter().any(|other| other.trial.name == this.trial.name) {
            this.trial.name = with_folder(&this.path, &this.trial.name);
        }
        if earlier.iter().any(|other| other.trial.name == this.trial.name) {
            let message = format!(
                "{}: another trial has the same name `{}`; list both in one manifest",
                this.file, this.trial.name
            );
            return Err(Failure::Refused(message));
        }
    }
    Ok(())
}

fn with_folder(path: &Path, name: &str) -> String {
    let folder =
        path.parent().and_then(Path::file_name).map(|folder| folder.to_string_lossy().into_owned());
    folder.map_or_else(|| name.to_owned(), |folder| format!("{folder}/{name}"))
}

/// Returns references to the trials.
pub fn trial_refs(read: &[ReadTrial]) -> Vec<&Trial> {
    read.iter().map(|read| &read.trial).collect()
}

/// Returns the paths of everything that was read, which must not be overwritten.
pub fn input_paths(read: &[ReadTrial], paths: &[PathBuf]) -> Vec<PathBuf> {
    read.iter().map(|read| read.path.clone()).chain(paths.iter().cloned()).collect()
}

/// Prints a warning if a manifest names another ship than the command.
pub fn remark_other_ship(read: &[ReadTrial], ship: &str) {
    let mut others: Vec<&str> = read
        .iter()
        .filter_map(|read| read.ship.as_deref())
        .filter(|other| *other != ship)
        .collect();
    others.dedup();
    others.iter().for_each(|other| {
        print_note(&format!("warning: the manifest names the ship `{other}`, the command `{ship}`"))
    });
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::manifest::{Manifest, ManifestTrial, TrialConventions, TrialsKind};

    #[test]
    fn equal_names_are_told_apart_and_equal_files_refused() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a", "b"].map(|name| folder.path().join(name).join("t.csv"));
        for path in &paths {
            std::fs::create_dir(path.parent().unwrap()).unwrap();
            std::fs::write(path, "t_s,u_m_s\n0,1\n1,2\n2,3\n").unwrap();
        }
        let read = read_trials(&paths).unwrap();
        assert_eq!(
            trial_refs(&read).iter().map(|trial| trial.name.as_str()).collect::<Vec<_>>(),
            ["t.csv", "b/t.csv"]
        );
        let twice = [paths[0].clone(), paths[0].clone()];
        assert!(
            super::read_trials(&twice).unwrap_err().message().unwrap().contains("listed twice")
        );
    }

    #[test]
    fn sheets_are_parts_of_their_workbook() {
        let sheets = ["b.xlsx#part=A", "b.xlsx#part=B"].map(ManifestTrial::from_file_name);
        let manifest = Manifest {
            kind: TrialsKind::Trials,
            ship: String::new(),
            conventions: TrialConventions::default(),
            columns: Default::default(),
            trials: sheets.to_vec(),
        };
        let loaded = LoadedTrials { manifest: Some(manifest), trials: Vec::new() };
        let files = files_of(Path::new("folder/trials.yaml"), &loaded);
        let book = PathBuf::from("folder/b.xlsx");
        let wanted = ["b.xlsx#part=A", "b.xlsx#part=B"];
        assert_eq!(files, wanted.map(|label| (label.to_owned(), book.clone(), true)));
    }

    #[test]
    fn every_refusal_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a.csv", "b.csv"].map(|name| folder.path().join(name));
        paths.iter().for_each(|path| std::fs::write(path, "t_s,u_m_s\n0,1\n0,2\n").unwrap());
        let failure = read_trials(&paths).unwrap_err();
        let message = failure.message().unwrap();
        assert!(
            message.contains("a.csv is refused") && message.contains("b.csv is refused"),
            "{message}"
        );
        assert!(message.lines().last().is_some_and(|line| line.contains("sistership import")));
    }
}
