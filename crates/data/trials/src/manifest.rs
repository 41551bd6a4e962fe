//! Reading and checking of trial manifests.

use std::path::{Component, Path};

use sistership_model::FileError;
use sistership_model::manifest::Manifest;

use crate::declarations::{Declarations, North, SensorFile};
use crate::file_segments::{self, same_file};
use crate::manifest_file::{ManifestFile, Written};
use crate::resolve::{channel_names, unit_factor};
use crate::smoothing;
use crate::table::ColumnTarget;
use crate::units::UnitKind;

/// Reads a manifest with all its declarations; `file_name` is for messages only.
///
/// # Errors
/// Returns line and field of everything that is wrong: the YAML, an unknown channel or unit, a path
/// that leaves the folder, a file that is listed twice, impossible smoothing, an invalid
/// declaration.
pub fn read_manifest_file(file_name: &str, text: &str) -> Result<ManifestFile, FileError> {
    let inside = |file: &ManifestFile| {
        let trials = trials_outside(file).into_iter();
        trials.chain(sensors_outside(file)).collect()
    };
    read_checked(file_name, text, inside)
}

/// Reads a manifest on disk, which may name files outside its folder.
///
/// # Errors
/// Returns the errors of [`read_manifest_file`].
pub(crate) fn read_local_manifest(file_name: &str, text: &str) -> Result<ManifestFile, FileError> {
    read_checked(file_name, text, |_| Vec::new())
}

fn read_checked(
    file_name: &str,
    text: &str,
    further: impl Fn(&ManifestFile) -> Vec<ManifestProblem>,
) -> Result<ManifestFile, FileError> {
    let written: Written = sistership_model::yaml::read_document(text)
        .map_err(|error| FileError::from_yaml(file_name, error))?;
    let file = ManifestFile::from(written);
    let manifest = &file.manifest;
    // All problems are collected before any of them is reported.
    let problems = column_problems(&file)
        .chain(trial_problems(manifest))
        .chain(sensor_problems(&file))
        .chain(further(&file))
        .chain(convention_problem(manifest))
        .chain(exclusion_problems(&file))
        .chain(current_problems(&file))
        .chain(declaration_problems(&file.declarations));
    // The line is found by a text near the problem, as parsing has lost the positions.
    let refused = |ManifestProblem { field, near, message }: ManifestProblem| FileError {
        file: file_name.to_owned(),
        line: line_of(text, &near),
        field,
        message,
        further: Vec::new(),
    };
    FileError::from_faults(problems.map(refused)).map_or(Ok(()), Err)?;
    Ok(file)
}

struct ManifestProblem {
    field: String,
    /// Text by which the line of the problem is found.
    near: String,
    message: String,
}

fn column_problems(file: &ManifestFile) -> impl Iterator<Item = ManifestProblem> {
    let sensors = file.sensors.iter().flatten().flat_map(|sensor| &sensor.columns);
    let own = file.manifest.trials.iter().flat_map(|trial| &trial.columns);
    file.manifest.columns.iter().chain(own).chain(sensors).filter_map(|(name, mapped)| {
        let problem = |message: String| ManifestProblem {
            field: format!("columns.{name}"),
            near: format!("{name}:"),
            message,
        };
        let Some(target) = ColumnTarget::from_name(name) else {
            return Some(problem(format!(
                "`{name}` is not a channel; channels are {}",
                channel_names()
            )));
        };
        unit_factor(target, &mapped.unit, &file.declarations).err().map(problem)
    })
}

fn trial_problems(manifest: &Manifest) -> impl Iterator<Item = ManifestProblem> {
    let none = manifest.trials.is_empty().then(|| ManifestProblem {
        field: "trials".into(),
        near: "trials:".into(),
        message: "lists no trials; add one".into(),
    });
    let each = manifest.trials.iter().enumerate().filter_map(|(index, trial)| {
        let earlier = &manifest.trials[..index];
        if let Some((field, message)) = file_segments::segment_problem(trial, earlier) {
            let (field, near) = (format!("trials[{index}].{field}"), trial.file.clone());
            return Some(ManifestProblem { field, near, message });
        }
        // Several segments of one file may be listed, but the whole file only once.
        let twice = earlier.iter().any(|other| {
            same_file(&other.file, &trial.file) && !(other.is_segment() && trial.is_segment())
        });
        let is_wrong = |value: &f64| !(*value > 0.0 && value.is_finite());
        let message = match (trial.depth_m, trial.n_rps) {
            _ if twice => "is listed twice; the same data would count twice".to_owned(),
            (Some(depth), _) if is_wrong(&depth) => {
                format!("depth_m must be positive, not {depth}; omit it for deep water")
            }
            (_, Some(n_rps)) if is_wrong(&n_rps) => {
                format!("n_rps must be positive, not {n_rps}; omit it where they are recorded")
            }
            _ => return None,
        };
        Some(ManifestProblem {
            field: format!("trials[{index}].file"),
            near: trial.file.clone(),
            message: format!("`{}` {message}", trial.file),
        })
    });
    none.into_iter().chain(each)
}

fn sensor_problems(file: &ManifestFile) -> impl Iterator<Item = ManifestProblem> {
    let is_wrong =
        |sensor: &&SensorFile| sensor.clock_offset_s.is_some_and(|offset| !offset.is_finite());
    file.sensors.iter().flatten().filter(is_wrong).map(|sensor| ManifestProblem {
        field: "trials.sensors".into(),
        near: sensor.file.clone(),
        message: format!("`{}`: clock_offset_s must be a number", sensor.file),
    })
}

/// Returns the trials whose file is outside the folder of the manifest.
fn trials_outside(file: &ManifestFile) -> Vec<ManifestProblem> {
    let trials = file.manifest.trials.iter().enumerate();
    trials
        .filter(|(_, trial)| !stays_inside(&trial.file))
        .map(|(index, trial)| folder_problem(format!("trials[{index}].file"), &trial.file))
        .collect()
}

fn sensors_outside(file: &ManifestFile) -> Vec<ManifestProblem> {
    let sensors = file.sensors.iter().flatten().filter(|sensor| !stays_inside(&sensor.file));
    sensors.map(|sensor| folder_problem("trials.sensors".into(), &sensor.file)).collect()
}

fn folder_problem(field: String, path: &str) -> ManifestProblem {
    let message = format!("`{path}` must be a path relative to the manifest, inside its folder");
    ManifestProblem { field, near: path.to_owned(), message }
}

fn exclusion_problems(file: &ManifestFile) -> impl Iterator<Item = ManifestProblem> {
    let problem = |near: &str, message: String| ManifestProblem {
        field: "exclude".into(),
        near: near.to_owned(),
        message,
    };
    file.declarations.exclude.iter().filter_map(move |one| {
        let unknown = one.channel.as_deref().filter(|name| ColumnTarget::from_name(name).is_none());
        if let Some(name) = unknown {
            let message = format!("`{name}` is not a channel; channels are {}", channel_names());
            return Some(problem(name, message));
        }
        if !file.manifest.trials.iter().any(|trial| trial.file == one.file) {
            let message = format!("`{}` is not the file of a trial", one.file);
            return Some(problem(&one.file, message));
        }
        let is_open = one.rows.is_none() && one.from.is_none() && one.to.is_none();
        is_open.then(|| problem(&one.why, "give `rows`, or `from` and `to`".into()))
    })
}

fn current_problems(file: &ManifestFile) -> impl Iterator<Item = ManifestProblem> {
    let known = |one: &str| file.manifest.trials.iter().any(|trial| trial.trial_label() == one);
    let unknown = file.declarations.currents.iter().filter(move |one| !known(&one.trial));
    unknown.map(|one| {
        let message = format!("`{}` is not a trial; write its file, as under `trials`", one.trial);
        ManifestProblem { field: "currents".into(), near: one.trial.clone(), message }
    })
}

fn declaration_problems(declared: &Declarations) -> impl Iterator<Item = ManifestProblem> {
    let problem = |field: &str, message: String| ManifestProblem {
        field: field.into(),
        near: format!("{}:", field.rsplit('.').next().unwrap_or(field)),
        message,
    };
    let variation = declared.variation_deg;
    let heading = match (declared.heading, variation) {
        (North::Magnetic, None) => {
            let message = "a magnetic heading needs the magnetic variation; add `variation_deg`, \
                           positive to the east";
            Some(problem("heading", message.into()))
        }
        (North::True, Some(_)) => {
            let message = "applies to magnetic headings only; add `heading: magnetic`";
            Some(problem("variation_deg", message.into()))
        }
        _ => None,
    };
    let is_angle = variation.is_none_or(|variation| (-180.0..=180.0).contains(&variation));
    let angle =
        (!is_angle).then(|| problem("variation_deg", "must be between -180 and 180".into()));
    // No point of a ship is 1000 m from midship.
    let is_aboard = declared
        .antenna
        .is_none_or(|antenna| antenna.x_m.abs() < 1000.0 && antenna.y_m.abs() < 1000.0);
    let antenna = (!is_aboard)
        .then(|| problem("antenna", "must be a position on the ship, in m from midship".into()));
    let origin = declared.origin.is_some_and(|origin| !origin.is_valid()).then(|| {
        let message =
            "must have a latitude_deg from -90 to 90 and a longitude_deg from -180 to 180";
        problem("origin", message.into())
    });
    let maximum = declared.maximum.iter().filter_map(move |(name, maximum)| {
        let message = match ColumnTarget::from_name(name) {
            None => format!("`{name}` is not a channel; channels are {}", channel_names()),
            Some(_) if !(maximum.value > 0.0 && maximum.value.is_finite()) => {
                format!("must be positive, not {}", maximum.value)
            }
            Some(target) => UnitKind::from_target(target).unit_to_si(&maximum.unit).err()?,
        };
        Some(problem(&format!("maximum.{name}"), message))
    });
    [heading, angle, antenna, origin].into_iter().flatten().chain(maximum)
}

/// Returns true if a path stays inside the folder on any system: a backslash or colon has a further
/// meaning on Windows.
fn stays_inside(path: &str) -> bool {
    let plain = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    !path.is_empty() && !path.contains(['\\', ':', '\0']) && Path::new(path).components().all(plain)
}

fn convention_problem(manifest: &Manifest) -> Option<ManifestProblem> {
    let is_refused = |limit: &f64| *limit < 0.0 || limit.is_nan();
    if let Some(limit) = manifest.conventions.bridge_s.filter(is_refused) {
        return Some(ManifestProblem {
            field: "conventions.bridge_s".into(),
            near: "bridge_s:".into(),
            message: format!("must be a finite number of seconds, not {limit}"),
        });
    }
    let smoothing = manifest.conventions.smoothing?;
    let message = smoothing::check_settings(smoothing.window, smoothing.degree).err()?;
    Some(ManifestProblem {
        field: "conventions.smoothing".into(),
        near: "smoothing:".into(),
        message: message.to_string(),
    })
}

/// Returns the first line that contains the text at the start of a word.
fn line_of(text: &str, near: &str) -> Option<usize> {
    // At the start of a word: `n:` must not be found within `column:`.
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
        read_manifest_file("m.yaml", &GOOD.replace(from, to)).unwrap_err().to_string()
    }

    #[test]
    fn the_manifest_of_the_design_is_read() {
        let manifest = read_manifest_file("m.yaml", GOOD).unwrap().manifest;
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
    fn every_fault_is_told() {
        let text = GOOD.replace("  delta:", "  rudder:").replace("zigzag/a.csv", "../a.csv");
        let error = read_manifest_file("m.yaml", &text).unwrap_err().to_string();
        let lines: Vec<&str> = error.lines().collect();
        assert_eq!(lines.len(), 2, "{error}");
        assert!(lines[0].starts_with("m.yaml:6: columns.rudder"), "{error}");
        assert!(lines[1].starts_with("m.yaml:8: trials[0].file"), "{error}");
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
    fn declarations_are_checked_and_written_back() {
        let text = format!(
            "{GOOD}heading: magnetic\nvariation_deg: -3.5\nantenna: {{ x_m: -20, y_m: 1 }}\n\
             origin: {{ latitude_deg: 57.9, longitude_deg: 9.8 }}\nmaximum:\n  n: {{ value: 120, unit: rpm }}\nignore: [note]\nderive: [u, v]\n"
        );
        let text = text.replace("unit: rad }", "unit: '%' }");
        let refused = |from: &str, to: &str| {
            read_manifest_file("m", &text.replace(from, to)).unwrap_err().to_string()
        };
        assert!(refused("delta:", "psi:").contains("maximum"));
        let text = text.replace("  n:", "  delta:").replace("rpm", "deg");
        let file = read_manifest_file("m.yaml", &text).unwrap();
        assert_eq!(file.declarations.maximum["delta"].value, 120.0);
        assert_eq!(read_manifest_file("m", &file.to_yaml().unwrap()).unwrap(), file);
        let refused = |from: &str, to: &str| {
            read_manifest_file("m", &text.replace(from, to)).unwrap_err().to_string()
        };
        assert!(refused("variation_deg: -3.5\n", "").contains("add `variation_deg`"));
        assert!(refused("heading: magnetic\n", "").contains("add `heading: magnetic`"));
        assert!(refused("-3.5", ".inf").contains("between"));
        assert!(refused("-20", ".nan").contains("antenna"));
        assert!(refused("57.9", "97.9").contains("origin"));
        assert!(refused("value: 120", "value: 0").contains("positive"));
    }

    #[test]
    fn a_channel_is_mapped_once() {
        let twice = "unit: rad }\n  delta: { column: \"other\", unit: rad }\n";
        assert!(refused("unit: rad }\n", twice).contains("delta"));
    }
}
