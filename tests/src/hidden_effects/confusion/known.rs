//! What a person would get who knows the effect: the fitted model with the effect at its true
//! parameters.

use std::collections::BTreeMap;

use sistership_diagnosis::Diagnosis;
use sistership_model::Trial;
use sistership_model::effect::AppliedEffect;
use sistership_simulation::Ship;
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use super::super::baseline::BASELINE;

const CHANNELS: [&str; 6] = ["u", "v", "r", "psi", "x", "y"];
/// Errors so near to the noise that their ratio is one of noise.
const OF_NOISE: f64 = 1.05;

/// The errors of the diagnosed model by those of one that knows the effects: the geometric mean
/// over channels. `None` where both are noise throughout.
pub fn ratio(diagnosis: &Diagnosis, effects: &[AppliedEffect], trials: &[&Trial]) -> Option<f64> {
    let known = errors(effects, trials, diagnosis.settings.restart_s);
    let both = |channel: &&str| {
        Some((
            *diagnosis.after.get(*channel)?,
            *known.get(*channel)?,
            *diagnosis.noise.get(*channel)?,
        ))
    };
    let above = |&(after, known, noise): &(f64, f64, f64)| after.max(known) > OF_NOISE * noise;
    let logs = CHANNELS
        .iter()
        .filter_map(both)
        .filter(above)
        .map(|(after, known, _)| (after / known).ln());
    let logs: Vec<f64> = logs.collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

fn errors(
    effects: &[AppliedEffect],
    trials: &[&Trial],
    restart_s: Option<f64>,
) -> BTreeMap<String, f64> {
    let mut model = BASELINE.model.clone();
    model.effects = effects.to_vec();
    let ship = Ship::new(&model, &BASELINE.law).unwrap_or_else(|error| panic!("{error}"));
    // As the diagnosis does where nothing else is said.
    let restart_s = restart_s.unwrap_or(10.0 * ship.lpp_m() / ship.approach_speed_m_s());
    let settings = ReplaySettings { restart_s: Some(restart_s), ..ReplaySettings::default() };
    let mut total = SquaredError::default();
    for trial in trials {
        let replay =
            replay_trial(&ship, trial, &settings).unwrap_or_else(|error| panic!("{error}"));
        total.add(&SquaredError::from_trial(trial, &replay));
    }
    total.rmse_by_channel()
}
