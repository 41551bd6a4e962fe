//! State of a session at an instant, with its band.

use sistership_assessment::uncertainty::quantile;
use sistership_simulation::StateVector;
use sistership_simulation::state::at;

/// Names and quantiles of the ends of the 95 % band.
pub(super) const BAND_ENDS: [(&str, f64); 2] = [("low", 0.025), ("high", 0.975)];

/// State at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionSample {
    pub t_s: f64,
    pub state: StateVector,
    pub n_rps: f64,
    /// Ends of the band for each state; `None` without draws.
    pub band: Option<[StateVector; 2]>,
}

/// Returns the ends of the band of each state over the draws that have not stopped; `None` if there
/// is none left.
pub(super) fn quantile_band(states: Vec<StateVector>) -> Option<[StateVector; 2]> {
    let mut out = [StateVector::zeros(); 2];
    let mut values = Vec::with_capacity(states.len());
    for place in 0..=at::DELTA {
        values.clear();
        values.extend(states.iter().map(|state| state[place]));
        // Each state has its own quantiles: the ends of the band are no single simulation.
        values.sort_unstable_by(f64::total_cmp);
        for (end, (_, share)) in BAND_ENDS.iter().enumerate() {
            out[end][place] = quantile(&values, *share)?;
        }
    }
    Some(out)
}
