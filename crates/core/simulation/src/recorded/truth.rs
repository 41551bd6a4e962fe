//! Correction of a recorded trial for known errors of the instruments.

use sistership_model::trial::Trial;

use super::record::{MissingChannel, Record};
use crate::plant::Work;
use crate::ship::Ship;
use crate::state::RECORDED;

/// Returns a trial with the known errors of a ship's instruments removed. The rates of change,
/// which an instrument with a delay needs, are those of the ship at the recorded state, so that
/// they are no rougher than the record.
///
/// # Errors
/// The errors of [`replay`](super::replay).
pub fn as_true_instruments_say(ship: &Ship, trial: &Trial) -> Result<Trial, MissingChannel> {
    let record = Record::new(ship, trial)?;
    let (mut truth, mut work) = (trial.clone(), Work::default());
    for sample in 0..trial.len() {
        let state = ship.truth(
            trial.velocity,
            &record.state_at(sample),
            &record.inputs_at(sample, 0.0),
            &mut work,
        );
        for (channel, place) in RECORDED {
            if let Some(column) = truth.channels.get_mut(&channel) {
                column[sample] = state[place];
            }
        }
    }
    Ok(truth)
}
