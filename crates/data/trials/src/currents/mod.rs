//! Steady currents: estimated from recorded trials, stated in a manifest, and subtracted on reading.

mod current_estimate;
mod estimate;
mod steady_turn;
mod subtract;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_model::trial::Trial;

use current_estimate::{CurrentEstimate, common_current};
pub(crate) use subtract::subtract_current;

/// Velocity of the water over the ground during a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrialCurrent {
    /// Name of the trial: its file, with `#t=FROM,TO` for a segment.
    pub trial: String,
    /// Velocity of the water to the north, m/s.
    pub north_m_s: f64,
    /// Velocity of the water to the east, m/s.
    pub east_m_s: f64,
    /// Evidence.
    pub why: String,
}

impl TrialCurrent {
    /// Returns speed and direction in words: `0.50 m/s towards 37 deg`.
    pub fn summary_text(&self) -> String {
        let speed = self.north_m_s.hypot(self.east_m_s);
        let towards = self.east_m_s.atan2(self.north_m_s).to_degrees().rem_euclid(360.0);
        format!("{speed:.2} m/s towards {towards:.0} deg")
    }
}

/// Returns the current of each trial that shows one. Trials without evidence of their own, such as
/// zigzags, take that of the others if these agree.
pub fn estimate_currents(trials: &[Trial]) -> Vec<TrialCurrent> {
    let own: Vec<Option<(CurrentEstimate, String)>> =
        trials.iter().map(estimate::estimate_current).collect();
    let known: Vec<CurrentEstimate> = own.iter().flatten().map(|(one, _)| *one).collect();
    let common = common_current(&known);
    let each = trials.iter().zip(own).filter_map(|(trial, own)| {
        let (estimate, why) = match (own, common) {
            (Some(own), _) => own,
            (None, Some(common)) => (common, "that of the other trials".to_owned()),
            (None, None) => return None,
        };
        estimate.is_stated().then(|| TrialCurrent {
            trial: trial.name.clone(),
            north_m_s: round_to_mm(estimate.north),
            east_m_s: round_to_mm(estimate.east),
            why,
        })
    });
    each.collect()
}

fn round_to_mm(value: f64) -> f64 {
    (1e3 * value).round() / 1e3
}
