//! Classification of several files into trials, and sensors of a trial.

use std::path::{Path, PathBuf};

use crate::column_set::ColumnSet;

/// A file of a set.
#[derive(Debug, Clone)]
pub(crate) struct SetFile {
    /// Name in the manifest.
    pub name: String,
    pub folder: PathBuf,
    /// Index of its column set.
    pub shape: usize,
    /// First and last time, s, of the calendar where that is known.
    pub span: Option<ClockSpan>,
}

/// A span of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClockSpan {
    pub from_s: f64,
    pub to_s: f64,
    /// True if the times are calendar times.
    pub is_dated: bool,
}

/// Role of a file in a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileRole {
    Trial,
    /// A sensor of the trial with this index among the files.
    SensorOf(usize),
}

/// Returns the role of each file. A file with everything that a trial needs is a trial. If there is
/// none, the file with most channels in each folder is the trial. Other files are sensors: of the
/// trial with the largest overlap in time, and among equals of the one that shares most parts of
/// its name.
pub(crate) fn classify_files(files: &[SetFile], shapes: &[ColumnSet]) -> Vec<FileRole> {
    let complete = |file: &SetFile| shapes[file.shape].is_complete();
    let any = files.iter().any(complete);
    // Without any complete file, a trial is spread over files: each folder has a base.
    let base = |file: &SetFile| match any {
        true => complete(file),
        false => Some(file.shape) == richest_shape(files, shapes, &file.folder),
    };
    let trials: Vec<usize> = (0..files.len()).filter(|&at| base(&files[at])).collect();
    (0..files.len())
        .map(|at| match trials.contains(&at) {
            true => FileRole::Trial,
            false => {
                owning_trial(files, &trials, &files[at]).map_or(FileRole::Trial, FileRole::SensorOf)
            }
        })
        .collect()
}

/// Returns the column set with most channels among the files of a folder.
fn richest_shape(files: &[SetFile], shapes: &[ColumnSet], folder: &Path) -> Option<usize> {
    let here = files.iter().filter(|file| file.folder == folder).map(|file| file.shape);
    // `max_by_key` returns the last of equals: reversed, it is the first.
    here.rev().max_by_key(|&shape| shapes[shape].channel_count())
}

/// Returns the trial to which a sensor belongs.
fn owning_trial(files: &[SetFile], trials: &[usize], sensor: &SetFile) -> Option<usize> {
    let near: Vec<usize> =
        trials.iter().copied().filter(|&at| files[at].folder == sensor.folder).collect();
    let among = if near.is_empty() { trials.to_vec() } else { near };
    let overlap = |at: usize| clock_overlap(files[at].span, sensor.span);
    let most = among.iter().map(|&at| overlap(at)).fold(0.0, f64::max);
    let parts = name_parts(&sensor.name);
    let shared =
        |at: usize| name_parts(&files[at].name).iter().filter(|part| parts.contains(part)).count();
    // Clocks that all begin at zero overlap alike: then the names decide.
    let alike = among.into_iter().filter(|&at| overlap(at) >= 0.95 * most);
    alike.rev().max_by_key(|&at| shared(at))
}

/// Returns the fraction of the shorter span that both share; 1 for clocks that cannot be compared.
fn clock_overlap(one: Option<ClockSpan>, other: Option<ClockSpan>) -> f64 {
    let (Some(one), Some(other)) = (one, other) else { return 1.0 };
    if one.is_dated != other.is_dated {
        return 1.0;
    }
    let shared = one.to_s.min(other.to_s) - one.from_s.max(other.from_s);
    let shorter = (one.to_s - one.from_s).min(other.to_s - other.from_s);
    if shorter > 0.0 { (shared / shorter).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the runs of letters and of digits of a file name without its extension.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_overlap_by_the_shorter() {
        let span = |from_s, to_s| Some(ClockSpan { from_s, to_s, is_dated: true });
        assert_eq!(clock_overlap(span(0.0, 10.0), span(8.0, 12.0)), 0.5);
        assert_eq!(clock_overlap(span(0.0, 10.0), span(20.0, 30.0)), 0.0);
        assert_eq!(clock_overlap(None, span(20.0, 30.0)), 1.0);
    }
}
