//! Functional mock-up units: unpacked, loaded by a small program in C, and sailed beside our own
//! simulation; under Wine and by FMPy, too, where these are installed.
#![allow(clippy::unwrap_used)]

mod shared;

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use sistership_model::{Model, Zoo};

use shared::programs::run;
use shared::units::{ARM, LINUX, Machine, WINDOWS, reference, unpack};
use shared::{Circle, Track, exported, largest, own, sailed, ship, written};

const MOST: f64 = 1e-6;
/// Models with and without revolutions, roll and depth.
const MODELS: [&str; 4] = ["mariner", "kvlcc2", "sr108", "esso-tanker"];

/// Sails an unpacked FMU with values of variables by name.
fn track(
    (machine, program): (&Machine, &Path),
    (version, unit): (&str, &Path),
    (circle, exchange, values): (&Circle, bool, &[(&str, f64)]),
) -> Track {
    let mut command = machine.command(program, version, unit);
    command.args(circle.arguments());
    command.args(["0".repeat(64), u8::from(exchange).to_string()]);
    for (name, value) in values {
        command.args([reference(unit, name), format!("{value:?}")]);
    }
    Track::read(&run(&mut command).replace('\r', ""))
}

/// Sails the FMUs of some models; the calls are those of co-simulation, or of model exchange.
fn check(machine: &Machine, version: &str, exchange: bool, models: &[String]) {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let program = machine.importer(version, folder.path(), &[]);
    for name in models {
        let unit = folder.path().join(name);
        unpack(&exported(&zoo, name, &version.replace("fmi", "fmu")), &unit);
        let circle = Circle::of(&zoo, name, if models.len() > 4 { 5.0 } else { 15.0 });
        let found = track((machine, &program), (version, &unit), (&circle, exchange, &[]));
        let difference = largest(&circle, &found, &own(&zoo, name, &circle));
        println!("{version} exchange {exchange} {name}: {difference:.1e}");
        assert!(difference < MOST, "{version} {name}: {difference:e}");
    }
}

#[test]
fn fmi2_sails_as_we_do() {
    check(&LINUX, "fmi2", false, &MODELS.map(str::to_owned));
    check(&LINUX, "fmi2", true, &MODELS.map(str::to_owned));
}

#[test]
fn fmi3_sails_as_we_do() {
    check(&LINUX, "fmi3", false, &MODELS.map(str::to_owned));
    check(&LINUX, "fmi3", true, &MODELS.map(str::to_owned));
}

#[test]
fn every_model_of_the_zoo_sails_as_a_unit() {
    let zoo = Zoo::load_embedded().unwrap();
    check(&LINUX, "fmi2", false, &shared::models(&zoo));
}

#[test]
fn other_machines_sail_as_we_do() {
    for machine in [&WINDOWS, &ARM] {
        if !machine.is_here() {
            eprintln!("skipped: the compiler or the emulator of {machine:?} is missing");
            continue;
        }
        println!("{machine:?}");
        check(machine, "fmi2", false, &MODELS.map(str::to_owned));
        check(machine, "fmi3", true, &MODELS.map(str::to_owned));
    }
}

/// KVLCC2 with a coefficient, a parameter, two particulars and the steering gear changed, and the
/// same changes by the names of an FMU.
fn changed(zoo: &Zoo) -> (Model, [(&'static str, f64); 5]) {
    let mut model = zoo.find_model("kvlcc2").unwrap();
    let values = [
        ("N_r", 1.1 * model.coefficients["N_r"].value),
        ("a_H", 0.9 * model.parameters["a_H"].value),
        ("water_density_kg_m3", 1000.0),
        ("rudder_area_m2", 100.0),
        ("rudder_rate", 3_f64.to_radians()),
    ];
    model.coefficients.get_mut("N_r").unwrap().value = values[0].1;
    model.parameters.get_mut("a_H").unwrap().value = values[1].1;
    for (name, value) in &values[2..4] {
        model.particulars.get_mut(*name).unwrap().value = *value;
    }
    model.steering.rate_deg_s = 3.0;
    (model, values)
}

#[test]
fn what_is_set_is_sailed() {
    let zoo = Zoo::load_embedded().unwrap();
    let (model, values) = changed(&zoo);
    let folder = tempfile::tempdir().unwrap();
    let circle = Circle::of(&zoo, "kvlcc2", 15.0);
    let own_track = sailed(&ship(&zoo, &model), &circle);
    for version in ["fmi2", "fmi3"] {
        let program = LINUX.importer(version, folder.path(), &[]);
        let unit = folder.path().join(version).join("a folder");
        unpack(&exported(&zoo, "kvlcc2", &version.replace("fmi", "fmu")), &unit);
        let found = track((&LINUX, &program), (version, &unit), (&circle, false, &values));
        let difference = largest(&circle, &found, &own_track);
        println!("{version} with values set: {difference:.1e}");
        assert!(difference < MOST, "{version}: {difference:e}");
        let unset = track((&LINUX, &program), (version, &unit), (&circle, false, &[]));
        assert!(largest(&circle, &unset, &own_track) > 0.01, "the changes are felt");
    }
}

#[test]
fn parameters_without_a_motion_are_refused() {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let program = LINUX.importer("fmi2", folder.path(), &[]);
    unpack(&exported(&zoo, "kvlcc2", "fmu2"), folder.path());
    let values = [("step_s", 0.0), ("rudder_rate", -1.0), ("lpp_m", f64::NAN)];
    for ((name, value), words) in values.into_iter().zip(["step_s", "steering gear", "above 0"]) {
        let mut command = LINUX.command(&program, "fmi2", folder.path());
        command.args(["35", "10", "0.1", &"0".repeat(64), "0"]);
        command.args([reference(folder.path(), name), format!("{value:?}")]);
        let output = command.output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(4) && error.contains(words), "{name}: {error}");
    }
}

#[test]
fn units_hold_a_library_for_every_machine() {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let expected = [
        ("fmu2", ["linux64", "aarch64-linux", "win64", "darwin64", "darwin64"]),
        (
            "fmu3",
            ["x86_64-linux", "aarch64-linux", "x86_64-windows", "x86_64-darwin", "aarch64-darwin"],
        ),
    ];
    // First bytes of ELF, PE and universal binaries of macOS.
    let kinds: [&[u8]; 5] =
        [b"\x7fELF", b"\x7fELF", b"MZ", b"\xca\xfe\xba\xbe", b"\xca\xfe\xba\xbe"];
    for (format, folders) in expected {
        let unit = folder.path().join(format);
        unpack(&written(&zoo, &zoo.find_model("mariner").unwrap(), format), &unit);
        for (machine, kind) in folders.into_iter().zip(kinds) {
            let place = unit.join("binaries").join(machine);
            let library = std::fs::read_dir(&place).unwrap().next().unwrap().unwrap().path();
            assert!(std::fs::read(&library).unwrap().starts_with(kind), "{}", library.display());
        }
    }
}

#[test]
fn a_hundred_steps_a_second_run_at_a_hundred_times_real_time() {
    let zoo = Zoo::load_embedded().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let program = LINUX.importer("fmi2", folder.path(), &[]);
    unpack(&exported(&zoo, "kvlcc2", "fmu2"), folder.path());
    let circle = Circle { duration_s: 1000.0, step_s: 0.01, ..Circle::of(&zoo, "kvlcc2", 1.0) };
    let begun = Instant::now();
    let found = track((&LINUX, &program), ("fmi2", folder.path()), (&circle, false, &[]));
    let times = circle.duration_s / begun.elapsed().as_secs_f64();
    println!("100 Hz at {times:.0} times real time, printing every step");
    assert!(times > 100.0, "{times}");
    assert!(largest(&circle, &found, &own(&zoo, "kvlcc2", &circle)) < MOST);
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
        let own_track = own(&zoo, name, &circle);
        for format in ["fmu2", "fmu3"] {
            let file = folder.path().join(format!("{name}-{format}.fmu"));
            std::fs::write(&file, exported(&zoo, name, format)).unwrap();
            let mut command = Command::new(&python);
            command.arg(&script).arg(&file).args(circle.arguments());
            let difference = largest(&circle, &Track::read(&run(&mut command)), &own_track);
            println!("fmpy {format} {name}: {difference:.1e}");
            assert!(difference < MOST, "{format} {name}: {difference:e}");
        }
    }
}
