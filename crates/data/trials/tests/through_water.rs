//! A speed log through the water beside positions, and beside course and speed over ground.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use sistership_model::Trial;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;
use sistership_trials::{load_path, propose_manifest};

/// Northwards at 5 m/s over the ground, 4 m/s through the water: a current of 1 m/s from astern.
const GROUND_M_S: f64 = 5.0;
const WATER_M_S: f64 = 4.0;

fn log(header: &str, columns: impl Fn(f64) -> String) -> String {
    let rows = (0..60).map(|k| format!("{k},0.0,0.1,{}\n", columns(f64::from(k))));
    format!("t [s],heading [deg],rudder [deg],{header}\n{}", rows.collect::<String>())
}

fn read(folder: &Path, manifest: &str) -> Result<Trial, String> {
    std::fs::write(folder.join("m.yaml"), manifest).unwrap();
    let loaded = load_path(&folder.join("m.yaml")).map_err(|error| error.to_string())?;
    loaded.trials.into_iter().next().unwrap().map_err(|refusal| refusal.to_string())
}

fn proposed(text: &str) -> Trial {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.csv");
    std::fs::write(&file, text).unwrap();
    let manifest = propose_manifest("a", &[&file]).unwrap().manifest.to_yaml().unwrap();
    read(folder.path(), &manifest).unwrap()
}

fn middle(trial: &Trial, channel: Channel) -> f64 {
    trial.channel(channel).unwrap_or_else(|| panic!("no {channel}"))[30]
}

fn is_ground_beside_water(trial: &Trial) {
    assert_eq!(trial.velocity, VelocityFrame::Ground);
    let (u, u_water) = (middle(trial, Channel::U), middle(trial, Channel::UWater));
    assert!((u - GROUND_M_S).abs() < 0.05 && (u_water - WATER_M_S).abs() < 1e-9, "{u} {u_water}");
    let advises = |words: &str| trial.warnings.iter().any(|one| one.message.contains(words));
    assert!(!advises("positions drift"), "{:?}", trial.warnings);
}

#[test]
fn a_log_beside_positions_leaves_the_velocities_to_them() {
    is_ground_beside_water(&proposed(&log("STW [m/s],x [m],y [m]", |t| {
        format!("{WATER_M_S},{},0", GROUND_M_S * t)
    })));
}

#[test]
fn a_log_beside_course_and_speed_over_ground_leaves_the_velocities_to_them() {
    is_ground_beside_water(&proposed(&log(
        "Speed through water [m/s],SOG [m/s],COG [deg]",
        |_| format!("{WATER_M_S},{GROUND_M_S},0"),
    )));
}

#[test]
fn a_manifest_declares_each_channel() {
    let folder = tempfile::tempdir().unwrap();
    let columns = |_: f64| format!("{WATER_M_S},0.01,{GROUND_M_S},0.02");
    std::fs::write(folder.path().join("a.csv"), log("lu,lv,gu,gv", columns)).unwrap();
    let manifest = |conventions: &str, columns: &[(&str, &str)]| {
        let one = |(name, column): &(&str, &str)| {
            format!("  {name}: {{ column: {column}, unit: m/s }}\n")
        };
        let columns: String = columns.iter().map(one).collect();
        format!(
            "kind: trials\nship: a\nconventions: {{ {conventions} }}\ncolumns:\n  \
             t: {{ column: 't [s]', unit: s }}\n{columns}trials:\n  - {{ file: a.csv }}\n"
        )
    };
    let all = [("u", "gu"), ("v", "gv"), ("u_water", "lu"), ("v_water", "lv")];
    let trial = read(folder.path(), &manifest("", &all)).unwrap();
    assert_eq!((middle(&trial, Channel::U), middle(&trial, Channel::UWater)), (5.0, 4.0));
    let log = [("u", "lu"), ("v", "lv")];
    let trial = read(folder.path(), &manifest("velocity: water", &log)).unwrap();
    assert_eq!(trial.velocity, VelocityFrame::Water);
    assert_eq!((middle(&trial, Channel::U), trial.channel(Channel::UWater)), (4.0, None));
    let twice = [("u", "gu"), ("u_water", "lu")];
    let error = read(folder.path(), &manifest("velocity: water", &twice)).unwrap_err();
    assert!(error.contains("both give u_water; keep one"), "{error}");
}
