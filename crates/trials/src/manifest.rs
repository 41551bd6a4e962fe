//! Trial manifests: YAML in, checked manifest out.

use std::path::{Component, Path};

use sistership_model::FileError;
use sistership_model::manifest::Manifest;

use crate::resolve::channel_names;
use crate::smoothing;
use crate::table::Target;
use crate::units::Kind;

/// Reads a manifest; `file_name` is only for messages.
///
/// # Errors
/// Names line and field of what is wrong: the YAML, an unknown channel or unit, a path that leaves the folder, a file
/// named twice, impossible smoothing.
pub fn read_manifest(file_name: &str, text: &str) -> Result<Manifest, FileError> {
    let manifest: Manifest =
        sistership_model::yaml::read(text).map_err(|error| FileError::of_yaml(file_name, error))?;
    let problem =
        columns(&manifest).or_else(|| trials(&manifest)).or_else(|| conventions(&manifest));
    match problem {
        None => Ok(manifest),
        Some(Problem { field, near, message }) => Err(FileError {
            file: file_name.to_owned(),
            line: line_of(text, &near),
            field,
            message,
        }),
    }
}

struct Problem {
    field: String,
    /// Text that stands in the line at fault.
    near: String,
    message: String,
}

fn columns(manifest: &Manifest) -> Option<Problem> {
    manifest.columns.iter().find_map(|(name, mapped)| {
        let problem = |message: String| Problem {
            field: format!("columns.{name}"),
            near: format!("{name}:"),
            message,
        };
        let Some(target) = Target::by_name(name) else {
            return Some(problem(format!(
                "`{name}` is not a channel; channels are {}",
                channel_names()
            )));
        };
        Kind::of(target).factor(&mapped.unit).err().map(problem)
    })
}

fn trials(manifest: &Manifest) -> Option<Problem> {
    if manifest.trials.is_empty() {
        return Some(Problem {
            field: "trials".into(),
            near: "trials:".into(),
            message: "lists no file".into(),
        });
    }
    manifest.trials.iter().enumerate().find_map(|(index, trial)| {
        let twice =
            manifest.trials[..index].iter().any(|other| same_file(&other.file, &trial.file));
        let message = match trial.depth_m {
            _ if !stays_inside(&trial.file) => {
                "must be a path relative to the manifest that stays in its folder".to_owned()
            }
            _ if twice => "is listed twice; the same data would count twice".to_owned(),
            Some(depth) if !(depth > 0.0 && depth.is_finite()) => {
                format!("depth_m must be positive, not {depth}; leave it out for deep water")
            }
            _ => return None,
        };
        Some(Problem {
            field: format!("trials[{index}].file"),
            near: trial.file.clone(),
            message: format!("`{}` {message}", trial.file),
        })
    })
}

/// Whether two paths name the same file: `a.csv` is `./a.csv`.
fn same_file(one: &str, other: &str) -> bool {
    let plain = |path| {
        Path::new(path).components().filter(|part| *part != Component::CurDir).collect::<Vec<_>>()
    };
    plain(one) == plain(other)
}

/// Whether a path names something below the folder on any system: a backslash or colon would mean more on Windows.
fn stays_inside(path: &str) -> bool {
    let plain = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    !path.is_empty() && !path.contains(['\\', ':', '\0']) && Path::new(path).components().all(plain)
}

fn conventions(manifest: &Manifest) -> Option<Problem> {
    let smoothing = manifest.conventions.smoothing?;
    let message = smoothing::check(smoothing.window, smoothing.degree).err()?;
    Some(Problem {
        field: "conventions.smoothing".into(),
        near: "smoothing:".into(),
        message: message.to_string(),
    })
}

/// The first line in which the text stands as a word of its own.
fn line_of(text: &str, near: &str) -> Option<usize> {
    let stands = |line: &str| {
        line.match_indices(near).any(|(at, _)| {
            line[..at]
                .chars()
                .next_back()
                .is_none_or(|before| !before.is_alphanumeric() && before != '_')
        })
    };
    text.lines().position(stands).map(|index| index + 1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const GOOD: &str = "kind: trials
ship: esso-osaka-3m
conventions: { rudder_positive: starboard_turn, wind: { kind: true, direction: from } }
columns:
  t:     { column: \"t [s]\", unit: s }
  delta: { column: \"delta_rudder [rad]\", unit: rad }
trials:
  - { file: zigzag/a.csv, manoeuvre: zigzag 15/15, depth_m: null }
";

    fn refused(from: &str, to: &str) -> String {
        assert!(GOOD.contains(from));
        read_manifest("m.yaml", &GOOD.replace(from, to)).unwrap_err().to_string()
    }

    #[test]
    fn the_manifest_of_the_design_is_read() {
        let manifest = read_manifest("m.yaml", GOOD).unwrap();
        assert_eq!(manifest.columns.len(), 2);
        assert_eq!(manifest.trials[0].manoeuvre.as_deref(), Some("zigzag 15/15"));
    }

    #[test]
    fn faults_name_line_and_remedy() {
        assert!(
            refused("  delta:", "  rudder:").starts_with(
                "m.yaml:6: columns.rudder: `rudder` is not a channel; channels are t, x"
            )
        );
        assert!(refused("unit: s }", "unit: m }").starts_with("m.yaml:5: columns.t: unit `m`"));
        assert!(refused("starboard_turn", "left").starts_with("m.yaml:3"));
        assert!(
            refused("direction: from }", "direction: from }, smoothing: { window: 4, degree: 2 }")
                .contains("odd")
        );
    }

    #[test]
    fn paths_stay_in_the_folder() {
        for path in ["../a.csv", "/etc/passwd", "zigzag/../../a.csv", "'C:\\a.csv'", "''"] {
            assert!(refused("zigzag/a.csv", path).contains("relative to the manifest"), "{path}");
        }
        assert!(refused("depth_m: null", "depth_m: -1").contains("positive"));
        assert!(
            refused("depth_m: null }\n", "depth_m: null }\n  - { file: zigzag/a.csv }\n")
                .contains("twice")
        );
        for again in ["./zigzag/a.csv", "zigzag//a.csv", "zigzag/./a.csv"] {
            assert!(
                refused(
                    "depth_m: null }\n",
                    &format!("depth_m: null }}\n  - {{ file: {again} }}\n")
                )
                .contains("twice")
            );
        }
    }

    #[test]
    fn a_channel_is_mapped_once() {
        let twice = "unit: rad }\n  delta: { column: \"other\", unit: rad }\n";
        assert!(refused("unit: rad }\n", twice).contains("delta"));
    }
}
