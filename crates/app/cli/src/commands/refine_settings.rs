//! Settings of a refinement from a file, and the held-out trials that they name.

use std::path::Path;

use sistership_identification::refine::RefinementSettings;
use sistership_model::FileError;

use crate::failure::Failure;
use crate::trials::ReadTrial;
use crate::zoo;

/// Reads and checks settings from a file.
///
/// # Errors
/// Returns an error that names line and field of each fault.
pub fn settings_file(path: &Path) -> Result<RefinementSettings, Failure> {
    let text = zoo::read_text_file(path)?;
    let refuse = |line: Option<usize>, field: String, message: String| FileError {
        file: path.display().to_string(),
        line,
        field,
        message,
        further: Vec::new(),
    };
    let read: Result<RefinementSettings, _> = sistership_model::yaml::read_document(&text);
    let settings =
        read.map_err(|error| FileError::from_yaml(&path.display().to_string(), error))?;
    // The check knows only the field; its line is the first that begins with the name.
    let line_of = |field: &str| {
        text.lines().position(|line| line.trim_start().starts_with(field)).map(|index| index + 1)
    };
    let faults = settings.check().err().unwrap_or_default().into_iter();
    let refused = faults.map(|of| refuse(line_of(&of.field), of.field, of.message));
    FileError::from_faults(refused).map_or(Ok(settings), |refused| Err(refused.into()))
}

/// Resolves the names of held-out trials: each may be given as the trial's name, as the file in the
/// manifest, or as the path.
///
/// # Errors
/// Returns an error that lists the known trials.
pub fn resolve_held_out(names: &[String], read: &[ReadTrial]) -> Result<Vec<String>, Failure> {
    let one = |name: &String| {
        let is_meant = |read: &&ReadTrial| {
            read.trial.name == *name || read.file == *name || read.path == Path::new(name)
        };
        let found = read.iter().find(is_meant).map(|read| read.trial.name.clone());
        let known: Vec<&str> = read.iter().map(|read| read.trial.name.as_str()).collect();
        found.ok_or_else(|| {
            Failure::Refused(format!(
                "--held-out {name}: there is no such trial; choose from {}",
                known.join(", ")
            ))
        })
    };
    names.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn message(text: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.yaml");
        std::fs::write(&path, text).unwrap();
        settings_file(&path).map_or_else(
            |failure| failure.message().unwrap().to_owned(),
            |settings| settings.folds.to_string(),
        )
    }

    #[test]
    fn settings_are_read_or_refused_by_line() {
        assert_eq!(message("folds: 3\n"), "3");
        assert!(message("folds: 3\nlambda_count: 1\n").contains("s.yaml:2: lambda_count: must be"));
        let both = message("window_s: -1\nfolds: 1\n");
        assert!(both.contains("s.yaml:2: folds") && both.contains("s.yaml:1: window_s"), "{both}");
        assert!(message("lambda: 1\n").contains("unknown field `lambda`"));
    }

    #[test]
    fn trials_kept_out_are_known_by_name_and_file() {
        let trial = sistership_model::trial::Trial { name: "b.csv".into(), ..Default::default() };
        let read = [ReadTrial {
            trial,
            file: "a/b.csv".into(),
            path: "a/b.csv".into(),
            is_stretch: false,
            ship: None,
        }];
        let found = |name: &str| resolve_held_out(&[name.to_owned()], &read);
        assert_eq!(found("b.csv").unwrap(), ["b.csv"]);
        assert_eq!(found("a/b.csv").unwrap(), ["b.csv"]);
        assert!(found("c.csv").unwrap_err().message().unwrap().contains("choose from b.csv"));
    }
}
