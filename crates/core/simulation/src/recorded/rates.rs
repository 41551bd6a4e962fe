//! Rates of change that a model gives along a recorded trial.

use sistership_model::trial::Trial;

use super::record::{MissingChannel, Record};
use crate::branch::Instant;
use crate::plant::Work;
use crate::ship::Ship;

/// Returns the inputs of a learned correction at each sample of a trial, with the ship's own rates
/// at the recorded states.
///
/// # Errors
/// The errors of [`replay`](super::replay).
pub fn instants_along(ship: &Ship, trial: &Trial) -> Result<Vec<Instant>, MissingChannel> {
    let record = Record::new(ship, trial)?;
    let mut work = Work::default();
    let mut at_sample = |sample: usize| {
        let (said, inputs) = (record.state_at(sample), record.inputs_at(sample, 0.0));
        let state = ship.truth(trial.velocity, &said, &inputs, &mut work);
        let rate = ship.rate_with(&state, &inputs, &mut work);
        ship.instant(&state, &|slot| inputs[slot], &rate)
    };
    Ok((0..trial.len()).map(&mut at_sample).collect())
}
