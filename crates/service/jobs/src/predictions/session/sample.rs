//! Where a ship under way is at an instant, with the band of those beside it.

use sistership_assessment::uncertainty::quantile;
use sistership_simulation::StateVector;
use sistership_simulation::state::at;

/// The ends of a band of 95 %.
pub(super) const ENDS: [(&str, f64); 2] = [("low", 0.025), ("high", 0.975)];

/// A ship at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    pub t_s: f64,
    pub state: StateVector,
    pub n_rps: f64,
    /// The ends of the band, by state; none where nobody sails beside it.
    pub band: Option<[StateVector; 2]>,
}

/// The ends of the band of each state over those who still sail; none where nobody does.
pub(super) fn band(states: Vec<StateVector>) -> Option<[StateVector; 2]> {
    let mut out = [StateVector::zeros(); 2];
    let mut values = Vec::with_capacity(states.len());
    for place in 0..=at::DELTA {
        values.clear();
        values.extend(states.iter().map(|state| state[place]));
        values.sort_unstable_by(f64::total_cmp);
        for (end, (_, share)) in ENDS.iter().enumerate() {
            out[end][place] = quantile(&values, *share)?;
        }
    }
    Some(out)
}
