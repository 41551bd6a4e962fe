//! Rates of change that a model gives along a recorded trial.

use sistership_model::trial::Trial;
use sistership_model::trial_input::MissingInput;

use super::record::TrialRecord;
use crate::branch::CorrectionInstant;
use crate::plant::PlantWorkspace;
use crate::ship::Ship;

/// Returns the inputs of a learned correction at each sample of a trial, with the ship's own rates
/// at the recorded states.
///
/// # Errors
/// The errors of [`replay`](super::replay).
pub fn instants_along(ship: &Ship, trial: &Trial) -> Result<Vec<CorrectionInstant>, MissingInput> {
    let record = TrialRecord::new(ship, trial)?;
    let mut work = PlantWorkspace::default();
    let mut at_sample = |sample: usize| {
        let (said, inputs) =
            (record.recorded_state(sample), record.interpolate_inputs(sample, 0.0));
        let state = ship.true_state(trial.velocity, &said, &inputs, &mut work);
        let rate = ship.rate_with(&state, &inputs, &mut work);
        ship.correction_inputs(&state, &|slot| inputs[slot], &rate)
    };
    Ok((0..trial.len()).map(&mut at_sample).collect())
}
