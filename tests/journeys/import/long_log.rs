//! A log of half a day: its manoeuvres are found, cut out, and refined on.

use std::path::{Path, PathBuf};

use serde_json::Value;
use sistership_tests::binary;
use sistership_tests::voyage::{Order, Sailed, Voyage, write_csv};

use crate::sea_trials;

const ORDERS: [Order; 4] = [
    Order::Zigzag(10.0, 10.0),
    Order::Turn(-15.0, 600.0),
    Order::Zigzag(-20.0, 20.0),
    Order::PullOut(15.0, 300.0),
];

/// 100 000 rows at 2 Hz.
fn log(folder: &Path) -> (PathBuf, Sailed) {
    let sailed = Voyage::long(100_000, 1, &ORDERS).sail();
    let path = folder.join("log.csv");
    write_csv(std::fs::File::create(&path).expect("a file"), &sailed.trial).expect("written");
    std::fs::write(folder.join("ship.yaml"), sea_trials::ship()).expect("written");
    (path, sailed)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("text")
}

#[test]
fn a_long_log_becomes_its_manoeuvres() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, sailed) = log(folder.path());
    let out = folder.path().join("trials.yaml");
    let call = ["import", text(&path), "--ship", sea_trials::NAME, "--length", "175"];
    let answer = binary::json(&[&call[..], &["--out", text(&out), "--json"]].concat(), 0);
    let found = answer["logs"][0]["stretches"].as_array().expect("stretches").clone();
    assert_eq!(found.len(), ORDERS.len(), "{found:#?}");
    let manifest = std::fs::read_to_string(&out).expect("a manifest");
    for (one, (order, from_s, to_s)) in found.iter().zip(&sailed.manoeuvres) {
        let time = |key: &str| one[key].as_f64().expect("a time");
        assert!(time("from_s") < *from_s && *to_s < time("to_s"), "{order}: {one:#}");
        let kind = match order {
            Order::Zigzag(..) => "zigzag",
            Order::Turn(..) => "turn",
            Order::PullOut(..) => "pull_out",
        };
        assert_eq!(one["kind"], kind, "{order}: {one:#}");
        assert!(one["why"].as_str().is_some_and(|why| why.contains("rudder")));
    }
    assert_eq!(manifest.matches("log.csv").count(), ORDERS.len(), "{manifest}");
    let steady: f64 = answer["logs"][0]["steady"].as_array().map_or(0.0, |parts| {
        let long = |part: &Value| Some(part["to_s"].as_f64()? - part["from_s"].as_f64()?);
        parts.iter().filter_map(long).sum()
    });
    assert!((0.7 * 5e4..5e4).contains(&steady), "{steady}");
    let read = answer["trials"].as_array().expect("trials");
    assert!(read.iter().all(|name| name.as_str().is_some_and(|name| name.contains("#t="))));
    refined(folder.path(), &out);
    refused(folder.path(), &manifest);
    told(&call, &out);
}

/// The manifest is refined on like any other, and a stretch is kept out by its name.
fn refined(folder: &Path, manifest: &Path) {
    let ship = folder.join("ship.yaml");
    let file = std::fs::read_to_string(manifest).expect("a manifest");
    let line = |key: &str| {
        let mut found = file.lines().filter_map(|line| line.trim().strip_prefix(key));
        found.next_back().expect("a stretch").trim().to_owned()
    };
    let last = |text: String| text.trim_end_matches(".0").to_owned();
    let name = format!("log.csv#t={},{}", last(line("from:")), last(line("to:")));
    let call = ["refine", "--ship", text(&ship), "--source", "mariner", "--method", "weak"];
    let trials = ["--trials", text(manifest), "--held-out", &name, "--json"];
    let answer = binary::json(&[&call[..], &trials].concat(), 0);
    let error = |model: &str| answer["held_out"][model]["psi"].as_f64().expect("an error");
    assert!(error("refined") < 0.5 * error("source"), "{answer:#}");
}

/// Faults of an entry name the file, the entry and the field.
fn refused(folder: &Path, manifest: &str) {
    let from = manifest.lines().find(|line| line.trim().starts_with("from:")).expect("a stretch");
    let bad = folder.join("bad.yaml");
    for (line, wanted) in [
        ("from: 1.0e9", "must be before `to`"),
        ("from: -5", "`from`: -5 s lies before the first row of the file"),
        ("from: '09:00:00'", "`from`: `09:00:00` is a clock time"),
    ] {
        std::fs::write(&bad, manifest.replacen(from.trim(), line, 1)).expect("written");
        let output = binary::run(&["check", text(&bad)]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned()
            + &String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains(wanted), "{line}: {said}");
    }
}

/// For people: a table, and what is left.
fn told(call: &[&str], out: &Path) {
    let output = binary::run(&[call, &["--out", text(out)]].concat());
    let said = String::from_utf8_lossy(&output.stdout);
    for wanted in ["a log of 13.9 h and 100000 rows with 4 manoeuvres", "pull-out", "for drift"] {
        assert!(said.contains(wanted), "{said}");
    }
}
