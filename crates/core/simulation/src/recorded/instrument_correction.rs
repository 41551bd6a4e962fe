//! Correction of a recorded trial for known errors of the instruments.

use sistership_model::trial::Trial;
use sistership_model::trial_input::MissingInput;

use super::record::TrialRecord;
use crate::plant::PlantWorkspace;
use crate::ship::Ship;
use crate::state::RECORDED_CHANNELS;

/// Returns a trial with the known errors of a ship's instruments removed. The rates of change,
/// which an instrument with a delay needs, are those of the ship at the recorded state, so that
/// they are no rougher than the record.
///
/// # Errors
/// The errors of [`replay`](super::replay).
pub fn correct_instrument_errors(ship: &Ship, trial: &Trial) -> Result<Trial, MissingInput> {
    let record = TrialRecord::new(ship, trial)?;
    let (mut truth, mut work) = (trial.clone(), PlantWorkspace::default());
    for sample in 0..trial.len() {
        let state = ship.true_state(
            trial.velocity,
            &record.recorded_state(sample),
            &record.interpolate_inputs(sample, 0.0),
            &mut work,
        );
        for (channel, place) in RECORDED_CHANNELS {
            if let Some(column) = truth.channels.get_mut(&channel) {
                column[sample] = state[place];
            }
        }
    }
    Ok(truth)
}
