//! Every measured and reference file that the project is given reads without an error.
//!
//! The files lie beside the project, not in it. Where they are missing the tests say so and pass,
//! unless `SISTERSHIP_REQUIRE_SHARED=1` asks for them.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use sistership_model::manifest::Manifest;
use sistership_model::trial::{Channel, Trial};
use sistership_trials::samples::{from_parquet, to_parquet};
use sistership_trials::{
    Mapping, Refusal, TrialFile, check_source, load_path, read_manifest_file, read_trial,
};

const ESSO_OSAKA: &str = r#"
kind: trials
ship: esso-osaka-3m
conventions: { rudder_positive: starboard_turn, velocity: ground, wind: { kind: true, direction: from }, missing: drop }
columns:
  t: { column: "t [s]", unit: s }
  x: { column: "x_position_mid [m]", unit: m }
  y: { column: "y_position_mid [m]", unit: m }
  psi: { column: "psi_hat [rad]", unit: rad }
  u: { column: "u_velo [m/s]", unit: m/s }
  v: { column: "vm_velo [m/s]", unit: m/s }
  r: { column: "r_angvelo [rad/s]", unit: rad/s }
  delta: { column: "delta_rudder [rad]", unit: rad }
  n: { column: "n_prop [rps]", unit: rps }
  wind_speed: { column: "wind_velo_true [m/s]", unit: m/s }
  wind_from: { column: "wind_dir_true [rad]", unit: rad }
  apparent_wind_speed: { column: "wind_velo_relative_mid [m/s]", unit: m/s }
  apparent_wind_from: { column: "wind_dir_relative_mid [rad]", unit: rad }
trials: [{ file: any.csv }]
"#;

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(
        std::env::var_os("SISTERSHIP_REQUIRE_SHARED").is_none_or(|value| value != "1"),
        "../shared/data is missing"
    );
    println!("skipped: ../shared/data is missing");
    None
}

fn csv_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.extension() {
            _ if path.is_dir() => files.extend(csv_files(&path)),
            Some(extension) if extension == "csv" => files.push(path),
            _ => {}
        }
    }
    files.sort();
    files
}

fn esso_osaka() -> Mapping {
    let manifest: Manifest = read_manifest_file("esso-osaka.yaml", ESSO_OSAKA).unwrap().manifest;
    Mapping::from_manifest(&manifest, &manifest.trials[0])
}

fn read(path: &Path, mapping: &Mapping) -> Result<Trial, Refusal> {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    read_trial(TrialFile::open(name, path).unwrap(), mapping)
}

fn show(trial: &Trial) {
    println!("{}: {} rows, {:.1} s", trial.name, trial.len(), trial.duration_s());
    for warning in &trial.warnings {
        println!("    {:?} {:?} {}", warning.row, warning.column, warning.message);
    }
}

#[test]
fn measured_trials_of_the_esso_osaka_model_are_accepted() {
    let Some(folder) = shared() else { return };
    let files = csv_files(&folder.join("esso-osaka"));
    assert!(!files.is_empty());
    for file in files {
        let trial = read(&file, &esso_osaka()).unwrap();
        show(&trial);
        assert_eq!(trial.channels.len(), 12);
        assert!(trial.channels.values().flatten().all(|value| value.is_finite()));
        assert_eq!(from_parquet(to_parquet(&trial).unwrap().into()).unwrap(), trial);
    }
}

#[test]
fn missing_values_are_refused_unless_they_may_be_dropped() {
    let Some(folder) = shared() else { return };
    let file = folder.join("esso-osaka/zigzag/zigzag_31-Jul-2020_13_50_28.csv");
    let mut mapping = esso_osaka();
    let dropped = read(&file, &mapping).unwrap();
    assert_eq!(dropped.len(), 1701);
    assert!(
        dropped
            .warnings
            .iter()
            .any(|warning| warning.message.starts_with("rows 1703 to 2029 skipped"))
    );
    mapping.conventions.missing = sistership_model::manifest::MissingValues::Refuse;
    let refusal = read(&file, &mapping).unwrap_err();
    assert_eq!(
        (refusal.findings[0].row, refusal.findings[0].column.as_deref()),
        (Some(1703), Some("t [s]"))
    );
}

#[test]
fn reference_simulations_and_examples_are_accepted() {
    let Some(folder) = shared() else { return };
    for set in ["mariner", "esso-tanker", "sr108"] {
        for file in csv_files(&folder.join(set)) {
            let loaded = load_path(&file).unwrap();
            let trial = loaded.trials[0].as_ref().unwrap();
            show(trial);
            assert!(trial.channel(Channel::R).is_some() && trial.channel(Channel::Delta).is_some());
            assert!(
                !trial.warnings.iter().any(|warning| warning.message.contains("drift")),
                "speeds are over the ground"
            );
        }
    }
}

/// The same files with one convention broken are not accepted in silence.
#[test]
fn broken_conventions_are_found_in_most_real_files() {
    let Some(folder) = shared() else { return };
    let (mut files, mut rudder, mut degrees) = (0, 0, 0);
    let sets =
        ["esso-osaka", "esso-tanker", "mariner", "sr108"].map(|set| csv_files(&folder.join(set)));
    for file in sets.concat() {
        if file.to_string_lossy().contains("berthing") {
            continue;
        }
        let esso = file.to_string_lossy().contains("esso-osaka");
        let mut mapping = if esso { esso_osaka() } else { Mapping::with_canonical_names() };
        mapping.conventions.rudder_positive = sistership_model::manifest::RudderSign::PortTurn;
        let says = |mapping: &Mapping, what: &str| {
            let outcome = check_source(TrialFile::open("a", &file).unwrap(), mapping);
            let said = outcome.errors.iter().any(|error| error.message.contains(what));
            if !said {
                println!("{what} is not found in {}", file.display());
            }
            usize::from(said)
        };
        files += 1;
        rudder += says(&mapping, "rudder_positive");
        if esso {
            let told = |mapping: &Mapping, what: &str, text: &str| {
                let outcome = check_source(TrialFile::from_csv("a", text.as_bytes()), mapping);
                usize::from(outcome.errors.iter().any(|error| error.message.contains(what)))
            };
            let text = std::fs::read_to_string(&file).unwrap();
            let rate =
                mapping.columns.iter_mut().find(|(name, _)| name == "r").map(|(_, column)| column);
            let rate = rate.unwrap();
            rate.unit = "deg/s".into();
            let header = std::mem::replace(&mut rate.column, "yaw rate".into());
            // By what the header says of its unit, and by the samples where it says nothing.
            degrees += told(&mapping, "57.3", &text.replacen(&header, "yaw rate", 1));
            mapping
                .columns
                .iter_mut()
                .filter(|(name, _)| name == "r")
                .for_each(|(_, r)| r.column = header.clone());
            assert_eq!(told(&mapping, "the header has the unit `rad/s`", &text), 1);
        }
    }
    println!("{files} files: rudder sign found in {rudder}, yaw rate in wrong unit in {degrees}");
    assert!(10 * rudder >= 9 * files && degrees >= 25);
}
