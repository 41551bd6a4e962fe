//! How far simulations step that fit and compare.

use sistership_model::law::Law;

use super::thresholds::SELECTION;

/// A step of a law's simulations, s, where the ship sails its length in `length_s`.
pub(super) fn step_s(law: &Law, length_s: f64, economical: bool) -> f64 {
    length_s
        / match economical && !law.has_roll() {
            true => SELECTION.steps_a_length_economical,
            false => SELECTION.steps_a_length,
        }
}
