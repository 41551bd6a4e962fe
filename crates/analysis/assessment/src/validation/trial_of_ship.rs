//! A recorded trial of the ship for validation.

use sistership_model::trial::Trial;

/// A recorded trial of the ship.
#[derive(Debug, Clone, Copy)]
pub struct TrialOfShip<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its samples.
    pub trial: &'a Trial,
    /// True if the model was fitted on it; such a trial is no evidence.
    pub fitted: bool,
}
