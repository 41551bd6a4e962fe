//! Functional mock-up units: unpacked, loaded by a small program in C, and sailed beside our own
//! simulation; by FMPy, too, where a Python with it is named by `SISTERSHIP_FMPY`.
#![allow(clippy::unwrap_used)]

mod shared;

use std::io::Read;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use sistership_model::Zoo;

use shared::programs::run;
use shared::{Circle, Track, exported, identifier, largest, own};

const MOST: f64 = 1e-6;
/// Models with and without revolutions, roll and depth.
const MODELS: [&str; 4] = ["mariner", "kvlcc2", "sr108", "esso-tanker"];

fn unpacked(bytes: &[u8], folder: &Path) {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).unwrap();
        let place = folder.join(file.enclosed_name().unwrap());
        std::fs::create_dir_all(place.parent().unwrap()).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        std::fs::write(place, bytes).unwrap();
    }
}

/// A program that loads the library of an FMU as an importer does.
fn importer(folder: &Path, version: &str) -> std::path::PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/importer");
    let program = folder.join(version);
    let compiled = Command::new("cc")
        .args(["-std=gnu99", "-Wall", "-Wextra", "-Werror", "-O1", "-I"])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("runtime"))
        .arg(source.join(format!("{version}.c")))
        .args([Path::new("-o"), &program, Path::new("-ldl"), Path::new("-lm")])
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    program
}

/// Sails a model's FMU; the calls are those of co-simulation, then of model exchange.
fn sailed(version: &str, libraries: &str, exchange: bool) {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let program = importer(folder.path(), version);
    for name in MODELS {
        let place = folder.path().join(name);
        unpacked(&exported(&zoo, name, version.replace("fmi", "fmu").as_str()), &place);
        let library = place.join(libraries).join(format!("{}.so", identifier(&zoo, name)));
        if !library.exists() {
            eprintln!("skipped: FMUs made on this machine carry no library");
            return;
        }
        let circle = Circle::of(&zoo, name, 15.0);
        let mut command = Command::new(&program);
        command.arg(library).arg(&place).args(circle.arguments());
        command.args(["0".repeat(64), u8::from(exchange).to_string()]);
        let difference =
            largest(&circle, &Track::read(&run(&mut command)), &own(&zoo, name, &circle));
        println!("{version} exchange {exchange} {name}: {difference:.1e}");
        assert!(difference < MOST, "{version} {name}: {difference:e}");
    }
}

#[test]
fn fmi2_sails_as_we_do() {
    sailed("fmi2", "binaries/linux64", false);
    sailed("fmi2", "binaries/linux64", true);
}

#[test]
fn fmi3_sails_as_we_do() {
    sailed("fmi3", "binaries/x86_64-linux", false);
    sailed("fmi3", "binaries/x86_64-linux", true);
}

#[test]
fn a_hundred_steps_a_second_run_at_a_hundred_times_real_time() {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let program = importer(folder.path(), "fmi2");
    unpacked(&exported(&zoo, "kvlcc2", "fmu2"), folder.path());
    let library = folder.path().join("binaries/linux64/kvlcc2_mmg.so");
    if !library.exists() {
        return;
    }
    let circle = Circle { duration_s: 1000.0, step_s: 0.01, ..Circle::of(&zoo, "kvlcc2", 1.0) };
    let begun = Instant::now();
    let mut command = Command::new(program);
    command.arg(library).arg(folder.path()).args(circle.arguments());
    command.args(["0".repeat(64), "0".to_owned()]);
    let track = Track::read(&run(&mut command));
    let times = circle.duration_s / begun.elapsed().as_secs_f64();
    println!("100 Hz at {times:.0} times real time, printing every step");
    assert!(times > 100.0, "{times}");
    assert!(largest(&circle, &track, &own(&zoo, "kvlcc2", &circle)) < MOST);
}

#[test]
fn fmpy_finds_no_fault_and_sails_as_we_do() {
    let Ok(python) = std::env::var("SISTERSHIP_FMPY") else {
        eprintln!("skipped: SISTERSHIP_FMPY names no Python with FMPy");
        return;
    };
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/importer/by_fmpy.py");
    for name in MODELS {
        let circle = Circle::of(&zoo, name, 15.0);
        let track = own(&zoo, name, &circle);
        for format in ["fmu2", "fmu3"] {
            let file = folder.path().join(format!("{name}-{format}.fmu"));
            std::fs::write(&file, exported(&zoo, name, format)).unwrap();
            let mut command = Command::new(&python);
            command.arg(&script).arg(&file).args(circle.arguments());
            let difference = largest(&circle, &Track::read(&run(&mut command)), &track);
            println!("fmpy {format} {name}: {difference:.1e}");
            assert!(difference < MOST, "{format} {name}: {difference:e}");
        }
    }
}
