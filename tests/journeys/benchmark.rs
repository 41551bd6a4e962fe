//! The benchmark of identification: one row of a made ship with two peers and the program.

use std::path::Path;
use std::process::Command;

use serde_json::Value;
use sistership_tests::binary;

/// The program, the floor and a ridge are fitted and judged, and the program has the least error.
#[test]
fn benchmark_row() {
    if !has_numpy() {
        eprintln!("skipped: no python3 with numpy");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    run(folder.path(), &[]);
    let text = std::fs::read_to_string(folder.path().join("results.json")).expect("results");
    // What was run is read from the CSV file, and nothing is fitted twice.
    assert!(!run(folder.path(), &["--add"]).contains("made-cargo-1 trials-4"));
    let document: Value = serde_json::from_str(&text).expect("JSON");
    let error = |peer: &str| {
        let rows = document["rows"].as_array().expect("rows");
        let row = rows.iter().find(|row| row["peer"] == peer).expect("a row of each peer");
        row["standardised_error"].as_f64().unwrap_or_else(|| panic!("{row}"))
    };
    assert!(error("sistership") < error("ridge_numpy"), "{text}");
    assert!(error("ridge_numpy") < error("nomoto"), "{text}");
}

/// Runs three peers on one task into a folder; returns what it says of each fit.
fn run(folder: &Path, more: &[&str]) -> String {
    let script =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/identification/benchmark.py");
    let output = Command::new("python3")
        .args([Path::new("-B"), &script])
        .args(["--data", "made-cargo-1", "--tasks", "trials-4"])
        .args(["--peers", "nomoto,ridge_numpy,sistership", "--out"])
        .arg(folder)
        .args(more)
        .env("SISTERSHIP_PROGRAM", binary::path())
        .output()
        .expect("python3 runs");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{text}");
    text
}

fn has_numpy() -> bool {
    let output = Command::new("python3").args(["-c", "import numpy"]).output();
    output.is_ok_and(|output| output.status.success())
}
