//! Exports sail a turning circle at 35 deg beside our own simulation. Interpreters that a machine
//! lacks are skipped, and said so; a C compiler is there, since Rust links with it.
#![allow(clippy::unwrap_used)]

mod shared;

use std::path::Path;
use std::process::Command;

use sistership_model::Zoo;

use shared::programs::{by_c, run};
use shared::{Circle, Track, exported, largest, models, own};

/// What is allowed, by ship length, approach speed, and radians.
const MOST: f64 = 1e-6;

fn by_python(folder: &Path, code: &[u8], circle: &Circle) -> Option<Track> {
    let file = folder.join("model.py");
    std::fs::write(&file, code).unwrap();
    let there = Command::new("python3").arg("--version").output().is_ok_and(|o| o.status.success());
    if !there {
        eprintln!("skipped: no python3");
        return None;
    }
    // Isolated and without site packages: numpy is not needed.
    let mut python = Command::new("python3");
    Some(Track::read(&run(python.args(["-I", "-S"]).arg(&file).args(circle.arguments()))))
}

fn by_octave(folder: &Path, model: &str, code: &[u8], circle: &Circle) -> Option<Track> {
    let there = Command::new("octave-cli").arg("--version").output();
    if !there.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: no octave-cli");
        return None;
    }
    std::fs::write(folder.join(format!("{model}.m")), code).unwrap();
    let script = include_str!("circle.m").replace("MODEL", model);
    std::fs::write(folder.join("circle.m"), script).unwrap();
    let call = format!("circle({})", circle.arguments().join(", "));
    let mut octave = Command::new("octave-cli");
    let output = run(octave.current_dir(folder).args(["--no-init-file", "--eval", &call]));
    Some(Track::read(&output))
}

fn within(what: &str, name: &str, difference: f64) {
    println!("{what} {name}: {difference:.1e}");
    assert!(difference < MOST, "{what} {name}: {difference:e}");
}

#[test]
fn c_turns_every_model_of_the_zoo_as_we_do() {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in models(&zoo) {
        let circle = Circle::of(&zoo, &name, 20.0);
        let code = exported(&zoo, &name, "c");
        let track = by_c(folder.path(), &code, &circle.arguments());
        within("c", &name, largest(&circle, &track, &own(&zoo, &name, &circle)));
    }
}

#[test]
fn python_and_octave_turn_as_we_do() {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["mariner", "kvlcc2", "sr108", "esso-tanker"] {
        let circle = Circle::of(&zoo, name, 8.0);
        let track = own(&zoo, name, &circle);
        if let Some(found) = by_python(folder.path(), &exported(&zoo, name, "python"), &circle) {
            within("python", name, largest(&circle, &found, &track));
        }
        let (code, model) = (exported(&zoo, name, "matlab"), shared::identifier(&zoo, name));
        if let Some(found) = by_octave(folder.path(), &model, &code, &circle) {
            within("matlab", name, largest(&circle, &found, &track));
        }
    }
}

#[test]
fn modelica_read_by_pymoca_turns_as_we_do() {
    let Ok(python) = std::env::var("SISTERSHIP_PYMOCA") else {
        eprintln!("skipped: SISTERSHIP_PYMOCA names no Python with pymoca and casadi");
        return;
    };
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/importer/by_pymoca.py");
    for name in ["mariner", "kvlcc2", "sr108"] {
        let (circle, model) = (Circle::of(&zoo, name, 5.0), shared::identifier(&zoo, name));
        let file = folder.path().join(format!("{model}.mo"));
        std::fs::write(file, exported(&zoo, name, "modelica")).unwrap();
        let mut command = Command::new(&python);
        command.arg(&script).arg(folder.path()).arg(&model).args(circle.arguments());
        let found = Track::read(&run(&mut command));
        within("modelica", name, largest(&circle, &found, &own(&zoo, name, &circle)));
    }
}
