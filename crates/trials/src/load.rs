//! What a command line names: a manifest, or one file.

use std::path::{Path, PathBuf};

use sistership_model::FileError;
use sistership_model::manifest::Manifest;
use sistership_model::trial::{Finding, Trial};

use crate::declarations::SensorFile;
use crate::manifest::read_manifest_file;
use crate::mapping::Mapping;
use crate::outcome::{CheckOutcome, Refusal};
use crate::read::{check, read_trial};
use crate::source::Source;

/// Trials read from a path.
#[derive(Debug)]
pub struct Loaded {
    /// The manifest, if the path named one.
    pub manifest: Option<Manifest>,
    /// Each file's trial, in the manifest's order.
    pub trials: Vec<Result<Trial, Refusal>>,
}

/// Reads a manifest (`.yaml`, `.yml`) with all its files, or a CSV or Parquet file with canonical column names.
///
/// # Errors
/// The manifest is wrong, or the path cannot be read. A single trial that is refused is no error of the whole.
pub fn load_path(path: &Path) -> Result<Loaded, FileError> {
    let (manifest, mut trials) = each(path, |listed| match listed.open() {
        Ok(source) => read_trial(source, &listed.mapping),
        Err(error) => Err(Refusal { file: listed.name, findings: vec![unreadable(&error)] }),
    })?;
    if manifest.is_none()
        && let (Some(Ok(trial)), Some(name)) = (trials.first_mut(), path.file_name())
    {
        // Where the file lies on this machine must not become part of a version's recipe.
        trial.name = name.to_string_lossy().into_owned();
    }
    Ok(Loaded { manifest, trials })
}

/// Checks what [`load_path`] would read, and keeps the outcomes only.
///
/// # Errors
/// As [`load_path`].
pub fn check_path(path: &Path) -> Result<Vec<CheckOutcome>, FileError> {
    let outcomes = each(path, |listed| match listed.open() {
        Ok(source) => check(source, &listed.mapping),
        Err(error) => CheckOutcome {
            file: listed.name,
            rows: 0,
            duration_s: 0.0,
            errors: vec![unreadable(&error)],
            warnings: Vec::new(),
        },
    })?;
    Ok(outcomes.1)
}

/// A file that is to be read, and the sensors' that belong to it.
struct Listed {
    name: String,
    path: PathBuf,
    mapping: Mapping,
    sensors: Vec<(SensorFile, PathBuf)>,
}

impl Listed {
    fn open(&self) -> std::io::Result<Source<'static>> {
        let mut source = Source::open(&self.name, &self.path)?;
        for (sensor, path) in &self.sensors {
            let named = |error| std::io::Error::other(format!("{}: {error}", sensor.file));
            let other = Source::open(&sensor.file, path).map_err(named)?;
            source =
                source.with_sensor(other, self.mapping.of_sensor(sensor), sensor.clock_offset_s);
        }
        Ok(source)
    }
}

fn each<T>(
    path: &Path,
    take: impl FnMut(Listed) -> T,
) -> Result<(Option<Manifest>, Vec<T>), FileError> {
    let shown = path.display().to_string();
    if !is_manifest(path) {
        std::fs::metadata(path).map_err(|error| missing(&shown, &error))?;
        let (mapping, sensors) = (Mapping::canonical(), Vec::new());
        let alone = Listed { name: shown, path: path.to_owned(), mapping, sensors };
        return Ok((None, [alone].map(take).into()));
    }
    let text = std::fs::read_to_string(path).map_err(|error| missing(&shown, &error))?;
    let written = read_manifest_file(&shown, &text)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let listed =
        written.manifest.trials.iter().zip(&written.sensors).map(|(trial, sensors)| Listed {
            name: trial.file.clone(),
            path: folder.join(&trial.file),
            mapping: written.mapping(trial),
            sensors: sensors.iter().map(|one| (one.clone(), folder.join(&one.file))).collect(),
        });
    let taken = listed.map(take).collect();
    Ok((Some(written.manifest), taken))
}

fn is_manifest(path: &Path) -> bool {
    path.extension().is_some_and(|extension| {
        extension.eq_ignore_ascii_case("yaml") || extension.eq_ignore_ascii_case("yml")
    })
}

fn missing(file: &str, error: &std::io::Error) -> FileError {
    FileError {
        file: file.to_owned(),
        line: None,
        field: String::new(),
        message: format!("cannot be read: {error}"),
    }
}

fn unreadable(error: &std::io::Error) -> Finding {
    Finding { row: None, column: None, message: format!("cannot be read: {error}") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const MANIFEST: &str = "kind: trials\nship: a\ncolumns: { u: { column: log, unit: kn } }\n\
                            trials: [{ file: a.csv, manoeuvre: zigzag 10/10 }, { file: lost.csv }]\n";

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
        assert_eq!(outcomes.iter().map(CheckOutcome::accepted).collect::<Vec<_>>(), [true, false]);
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
