//! Craft of other propulsion than a rudder behind a propeller, from vessel file to FMU.

use std::io::Read as _;
use std::path::Path;

use rand_chacha::ChaCha12Rng;
use sistership_tests::binary;
use sistership_tests::synthetic::replica;
use sistership_tests::truth::foreign::Kind;
use sistership_tests::truth::foreign::programme::programme;
use sistership_tests::truth::foreign::record::{Instruments, write_trials, write_vessel};

/// Trials of the programme that each craft has.
const TRIALS: usize = 4;
/// Seed of the craft, one of those for work.
const SEED: u64 = 1;

#[test]
fn a_catamaran_by_the_difference_of_two_thrusters() {
    let place =
        refined(Kind::Catamaran, &[("port", "thruster", "n_p"), ("starboard", "thruster", "n_s")]);
    let model = place.path().join("model.yaml").display().to_string();
    let turns = binary::json(&["manoeuvre", "--model", &model, "--turn", "35", "--json"], 0);
    let diameter_m = turns["turns"][0]["tactical_diameter_m"].as_f64().expect("a diameter");
    let lpp_m = Kind::Catamaran.craft(SEED).size().lpp_m;
    assert!((1.0..20.0).contains(&(diameter_m / lpp_m)), "{diameter_m} m of {lpp_m} m");
    let inputs = fmu_inputs(place.path(), &model);
    for side in ["n_port", "n_starboard"] {
        assert!(inputs.contains(&format!("name=\"{side}\"")), "{side} in {inputs}");
    }
    assert!(!inputs.contains("delta_order"), "{inputs}");
}

#[test]
fn a_ferry_with_two_propellers_and_rudders_by_one_engine_order() {
    let actuators = [
        ("port-propeller", "propeller", "n"),
        ("starboard-propeller", "propeller", "n"),
        ("port-rudder", "rudder", "delta"),
        ("starboard-rudder", "rudder", "delta"),
    ];
    steered_by_angle(Kind::TwinScrew, &actuators);
}

#[test]
fn a_ship_with_pods() {
    steered_by_angle(Kind::Pods, &[("port", "pod", "delta"), ("starboard", "pod", "delta")]);
}

#[test]
fn a_boat_with_an_outboard() {
    steered_by_angle(Kind::Outboard, &[("outboard", "outboard", "delta")]);
}

/// Refines a craft with a steering angle and finds its inputs in the FMU.
fn steered_by_angle(kind: Kind, actuators: &[(&str, &str, &str)]) {
    let place = refined(kind, actuators);
    let model = place.path().join("model.yaml").display().to_string();
    let inputs = fmu_inputs(place.path(), &model);
    for name in ["delta_order", "n"] {
        assert!(inputs.contains(&format!("name=\"{name}\"")), "{name} in {inputs}");
    }
}

/// A folder with `model.yaml`, refined by the default call without learned corrections.
fn refined(kind: Kind, actuators: &[(&str, &str, &str)]) -> tempfile::TempDir {
    let (craft, place) = (kind.craft(SEED), tempfile::tempdir().expect("a folder"));
    let vessel = write_vessel(place.path(), craft.size());
    add_actuators(&vessel, actuators, craft.size().beam_m);
    let instruments = Instruments::of(&craft);
    let trial = |(k, run): (usize, &sistership_tests::truth::foreign::simulate::Run)| {
        let mut rng: ChaCha12Rng = replica(SEED, k);
        (run.name(), instruments.columns(&craft, &run.simulate(&craft), &mut rng))
    };
    let seen: Vec<_> = programme(1.0).iter().take(TRIALS).enumerate().map(trial).collect();
    let trials = write_trials(place.path(), craft.size(), &seen);
    let model = place.path().join("model.yaml");
    let [vessel, trials, out] = [&vessel, &trials, &model].map(|path| path.display().to_string());
    let done = binary::run(&["refine", "--ship", &vessel, "--trials", &trials, "--out", &out]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    place
}

/// Writes the actuators into a vessel file: names, kinds and channels, those of either side at a
/// quarter of the beam.
fn add_actuators(vessel: &Path, actuators: &[(&str, &str, &str)], beam_m: f64) {
    let mut text = std::fs::read_to_string(vessel).expect("the vessel file");
    text += "actuators:\n";
    for (name, kind, channel) in actuators {
        let side = match name {
            name if name.starts_with("port") => -0.25,
            name if name.starts_with("starboard") => 0.25,
            _ => 0.0,
        };
        let y_m = side * beam_m;
        text += &format!(
            "  {name}: {{ kind: {kind}, y_m: {y_m:?}, channels: {{ {channel}: [] }}, source: yard }}\n"
        );
    }
    std::fs::write(vessel, text).expect("written");
}

/// Description of the variables of the FMU of a model.
fn fmu_inputs(folder: &Path, model: &str) -> String {
    let out = folder.join("model.fmu");
    let written = out.display().to_string();
    let done = binary::run(&["export", model, "--format", "fmu3", "--out", &written]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let mut archive =
        zip::ZipArchive::new(std::fs::File::open(&out).expect("a file")).expect("an archive");
    let mut text = String::new();
    let mut file = archive.by_name("modelDescription.xml").expect("the description");
    file.read_to_string(&mut text).expect("text");
    text
}
