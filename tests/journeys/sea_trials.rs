//! A ship to create and trials to upload, sailed by SR108's own law.

use serde_json::json;
use sistership_cli::sea_trials::{TrialManoeuvre, record_programme};
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;
use sistership_trials::samples::to_csv;

/// The name of the ship of the journeys.
pub const NAME: &str = "journey";

/// Particulars of a container ship of which nobody has a model.
pub fn ship() -> String {
    format!(
        "kind: vessel\nname: {NAME}\ntitle: The ship of the journeys\ncategory: \
         dry-cargo\nsources: {{ yard: {{ citation: the yard }} }}\nparticulars:\n  source: yard\n  \
         values: {{ lpp_m: 175.0, beam_m: 25.4, draught_m: 8.5, displacement_m3: 21222.0, \
         rudder_area_m2: 33.04, rudder_aspect_ratio: 1.82, propeller_diameter_m: 6.533, \
         service_speed_m_s: 10.47, x_g_m: 0.0, yaw_gyradius_ratio: 0.24 }}\n"
    )
}

/// Its trials, with the noise of real instruments.
pub fn trials() -> Vec<Trial> {
    let programme = [
        TrialManoeuvre::Zigzag(10.0, 10.0),
        TrialManoeuvre::Zigzag(20.0, 20.0),
        TrialManoeuvre::Turn(12.0),
        TrialManoeuvre::Turn(-20.0),
    ];
    sailed(&programme, 3)
}

/// Two of them, of which every fourth sample was kept: enough for a refinement that is not what is
/// looked at, which takes a tenth of the time.
pub fn few() -> Vec<Trial> {
    let programme = [TrialManoeuvre::Zigzag(10.0, 10.0), TrialManoeuvre::Zigzag(20.0, 20.0)];
    let mut trials = sailed(&programme, 3);
    for trial in &mut trials {
        let kept = |samples: &mut Vec<f64>| *samples = samples.iter().copied().step_by(4).collect();
        kept(&mut trial.t_s);
        trial.channels.values_mut().for_each(kept);
    }
    trials
}

/// Other trials of the same hull, as a sister would sail them.
pub fn sailed(programme: &[TrialManoeuvre], seed: u64) -> Vec<Trial> {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let model = zoo.find_model("sr108").unwrap_or_else(|error| panic!("{error}"));
    let ship = Ship::new(&model, zoo.law(&model.law).expect("the law of a zoo model"))
        .expect("a ready ship");
    record_programme(&ship, 10.47, programme, seed).unwrap_or_else(|stopped| panic!("{stopped}"))
}

/// A trial as a CSV file.
pub fn csv(trial: &Trial) -> Vec<u8> {
    let mut bytes = Vec::new();
    to_csv(&mut bytes, trial).expect("written to memory");
    bytes
}

/// The manifest of some trials. JSON is YAML.
pub fn manifest(trials: &[Trial]) -> String {
    let entries: Vec<_> = trials
        .iter()
        .map(|trial| json!({ "file": trial.name, "manoeuvre": trial.manoeuvre }))
        .collect();
    json!({ "kind": "trials", "ship": NAME, "trials": entries }).to_string()
}
