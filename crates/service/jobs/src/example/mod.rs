//! The example of the demonstration: a ship with particulars only, and trials that are simulations
//! of another ship with the noise of real instruments.

pub mod sea_trials;

use serde_json::{Value, json};
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;
use sistership_trials::samples::to_csv;

use self::sea_trials::{TrialManoeuvre, record_programme};

/// Ship of the example: particulars only, without a model.
pub const SHIP_YAML: &str = include_str!("ship.yaml");
/// Its name.
pub const SHIP_NAME: &str = "northern-star";
/// Ship that provides the trials: with roll, propeller and rudder, and a law that no other ship of
/// the zoo has.
pub const TRIAL_SHIP: &str = "sr108";
const SPEED_M_S: f64 = 10.47;
const SEED: u64 = 1;
/// Manoeuvres of the trials; the last two are held out from fit and selection, to judge the model.
const PROGRAMME: [TrialManoeuvre; 8] = [
    TrialManoeuvre::Zigzag(10.0, 10.0),
    TrialManoeuvre::Zigzag(-10.0, 5.0),
    TrialManoeuvre::Zigzag(20.0, 20.0),
    TrialManoeuvre::Turn(12.0),
    TrialManoeuvre::Turn(-15.0),
    TrialManoeuvre::Turn(30.0),
    TrialManoeuvre::Turn(-20.0),
    TrialManoeuvre::Zigzag(15.0, 15.0),
];
/// Number of trials at the end that are held out.
pub const HELD_OUT_TRIALS: usize = 2;

/// Simulates and records the trials.
///
/// # Errors
/// Returns the reason if the zoo lacks the ship, or if a simulation stops.
pub fn record_trials(zoo: &Zoo) -> Result<Vec<Trial>, String> {
    let model = zoo.find_model(TRIAL_SHIP).map_err(|error| error.to_string())?;
    let law = zoo.law(&model.law);
    let law = law.ok_or_else(|| format!("the law `{}` is not in the zoo", model.law))?;
    let ship = Ship::new(&model, law).map_err(|error| error.to_string())?;
    record_programme(&ship, SPEED_M_S, &PROGRAMME, SEED).map_err(|stopped| stopped.to_string())
}

/// Returns the files of trials by name, CSV.
///
/// # Errors
/// Returns the reason if a trial cannot be written.
pub fn trial_files(trials: &[Trial]) -> Result<Vec<(String, Vec<u8>)>, String> {
    let file = |trial: &Trial| {
        let mut bytes = Vec::new();
        to_csv(&mut bytes, trial).map_err(|error| error.to_string())?;
        Ok((trial.name.clone(), bytes))
    };
    trials.iter().map(file).collect()
}

/// Returns the manifest of the files.
pub fn trial_manifest(trials: &[Trial]) -> Value {
    let entry = |trial: &Trial| json!({ "file": trial.name, "manoeuvre": trial.manoeuvre });
    let entries: Vec<Value> = trials.iter().map(entry).collect();
    json!({ "kind": "trials", "ship": SHIP_NAME, "trials": entries })
}
