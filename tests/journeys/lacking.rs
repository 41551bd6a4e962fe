//! A ship with a published model, and trials that it sails with its rudder 4 degrees off what its
//! indicator says.

use std::collections::BTreeMap;

use serde_json::json;
use sistership_cli::sea_trials::{TrialManoeuvre, record_programme};
use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;

/// The name of the ship.
pub const NAME: &str = "lacking";
/// The effect that its model lacks, and how large it is, deg.
pub const EFFECT: &str = "rudder-offset";
pub const OFFSET_DEG: f64 = 4.0;
/// What is left of a trial: so many seconds, and one sample of so many (of 2 Hz).
const DURATION_S: f64 = 330.0;
const STRIDE: usize = 2;

fn zoo() -> Zoo {
    Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"))
}

/// Mariner under another name: a ship whose document publishes a model.
pub fn ship() -> String {
    zoo()
        .vessel_text("mariner")
        .expect("in the zoo")
        .replace("name: mariner", &format!("name: {NAME}"))
}

/// Three short trials sampled every two seconds, sailed with the rudder off.
pub fn trials() -> Vec<Trial> {
    sailed(
        &[
            TrialManoeuvre::Zigzag(10.0, 10.0),
            TrialManoeuvre::Turn(-12.0),
            TrialManoeuvre::Zigzag(-15.0, 10.0),
        ],
        OFFSET_DEG,
        5,
    )
}

/// One more of them.
pub fn further() -> Vec<Trial> {
    sailed(&[TrialManoeuvre::Turn(15.0), TrialManoeuvre::Zigzag(-10.0, 5.0)], OFFSET_DEG, 6)
}

/// Trials whose indicator says what the rudder does.
pub fn sound() -> Vec<Trial> {
    sailed(&[TrialManoeuvre::Zigzag(10.0, 10.0), TrialManoeuvre::Turn(-12.0)], 0.0, 7)
}

fn sailed(programme: &[TrialManoeuvre], offset_deg: f64, seed: u64) -> Vec<Trial> {
    let zoo = zoo();
    let mut model = zoo.find_model("mariner").unwrap_or_else(|error| panic!("{error}"));
    model.effects.extend((offset_deg != 0.0).then(|| rudder_off(&zoo, offset_deg)));
    let ship = Ship::new(&model, zoo.law(&model.law).expect("the law of a zoo model"))
        .expect("a ready ship");
    let trials =
        record_programme(&ship, 7.7, programme, seed).unwrap_or_else(|stopped| panic!("{stopped}"));
    trials.into_iter().map(coarse).collect()
}

fn rudder_off(zoo: &Zoo, offset_deg: f64) -> AppliedEffect {
    let effect = zoo.effect(EFFECT).expect("in the library");
    let offset = Quantity::new(offset_deg.to_radians(), "the truth");
    let parameters = BTreeMap::from([("offset_rad".to_owned(), offset)]);
    AppliedEffect {
        name: EFFECT.into(),
        acts_on: effect.acts_on,
        parameters,
        form: effect.forms[0].file.clone(),
    }
}

fn coarse(trial: Trial) -> Trial {
    let kept = |values: &[f64]| -> Vec<f64> {
        let start =
            values.iter().zip(&trial.t_s).step_by(STRIDE).filter(|(_, t)| **t <= DURATION_S);
        start.map(|(value, _)| *value).collect()
    };
    let channels =
        trial.channels.iter().map(|(channel, values)| (*channel, kept(values))).collect();
    Trial { t_s: kept(&trial.t_s), channels, ..trial }
}

/// Their manifest. JSON is YAML.
pub fn manifest(trials: &[Trial]) -> String {
    let entries: Vec<_> = trials
        .iter()
        .map(|trial| json!({ "file": trial.name, "manoeuvre": trial.manoeuvre }))
        .collect();
    json!({ "kind": "trials", "ship": NAME, "trials": entries }).to_string()
}
