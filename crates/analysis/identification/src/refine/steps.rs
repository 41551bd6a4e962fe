//! Step of the simulations that fit and compare.

use sistership_model::law::Law;

use super::thresholds::SELECTION;

/// Returns the step of a law's simulations, s, for a ship that travels its own length in
/// `length_s`.
pub(super) fn step_s(law: &Law, length_s: f64) -> f64 {
    length_s
        / match law.has_roll() {
            true => SELECTION.steps_a_length_with_roll,
            false => SELECTION.steps_a_length,
        }
}
