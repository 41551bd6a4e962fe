//! Several files: which are trials, and which are sensors of a trial.

use std::path::{Path, PathBuf};

use crate::shape::Shape;

/// A file of a set.
#[derive(Debug, Clone)]
pub(crate) struct SetFile {
    /// As the manifest names it.
    pub name: String,
    pub folder: PathBuf,
    /// Its place among the shapes.
    pub shape: usize,
    /// First and last time, s, of the calendar where it is known.
    pub span: Option<Span>,
}

/// A span of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub from_s: f64,
    pub to_s: f64,
    /// Whether it is of the calendar.
    pub is_dated: bool,
}

/// What a file is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    Trial,
    /// A sensor of the trial at this place among the files.
    SensorOf(usize),
}

/// What each file is. A file with all that a trial needs is one; of others, the one with most
/// channels in each folder is the trial, and the rest are its sensors: of the trial whose clock
/// theirs overlaps most, of equals the one that shares most parts of its name.
pub(crate) fn parts(files: &[SetFile], shapes: &[Shape]) -> Vec<Part> {
    let complete = |file: &SetFile| shapes[file.shape].is_complete();
    let any = files.iter().any(complete);
    let base = |file: &SetFile| match any {
        true => complete(file),
        false => Some(file.shape) == richest(files, shapes, &file.folder),
    };
    let trials: Vec<usize> = (0..files.len()).filter(|&at| base(&files[at])).collect();
    (0..files.len())
        .map(|at| match trials.contains(&at) {
            true => Part::Trial,
            false => owner(files, &trials, &files[at]).map_or(Part::Trial, Part::SensorOf),
        })
        .collect()
}

/// The shape with most channels among the files of a folder.
fn richest(files: &[SetFile], shapes: &[Shape], folder: &Path) -> Option<usize> {
    let here = files.iter().filter(|file| file.folder == folder).map(|file| file.shape);
    // Of equals the first.
    here.rev().max_by_key(|&shape| shapes[shape].channels())
}

/// The trial that a sensor belongs to.
fn owner(files: &[SetFile], trials: &[usize], sensor: &SetFile) -> Option<usize> {
    let near: Vec<usize> =
        trials.iter().copied().filter(|&at| files[at].folder == sensor.folder).collect();
    let among = if near.is_empty() { trials.to_vec() } else { near };
    let overlap = |at: usize| overlap(files[at].span, sensor.span);
    let most = among.iter().map(|&at| overlap(at)).fold(0.0, f64::max);
    let parts = name_parts(&sensor.name);
    let shared =
        |at: usize| name_parts(&files[at].name).iter().filter(|part| parts.contains(part)).count();
    // Clocks that all begin at zero tell nothing: then names do.
    let alike = among.into_iter().filter(|&at| overlap(at) >= 0.95 * most);
    alike.rev().max_by_key(|&at| shared(at))
}

/// The part of the shorter span that both share; of clocks that cannot be compared, all.
fn overlap(one: Option<Span>, other: Option<Span>) -> f64 {
    let (Some(one), Some(other)) = (one, other) else { return 1.0 };
    if one.is_dated != other.is_dated {
        return 1.0;
    }
    let shared = one.to_s.min(other.to_s) - one.from_s.max(other.from_s);
    let shorter = (one.to_s - one.from_s).min(other.to_s - other.from_s);
    if shorter > 0.0 { (shared / shorter).clamp(0.0, 1.0) } else { 0.0 }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_overlap_by_the_shorter() {
        let span = |from_s, to_s| Some(Span { from_s, to_s, is_dated: true });
        assert_eq!(overlap(span(0.0, 10.0), span(8.0, 12.0)), 0.5);
        assert_eq!(overlap(span(0.0, 10.0), span(20.0, 30.0)), 0.0);
        assert_eq!(overlap(None, span(20.0, 30.0)), 1.0);
    }
}
