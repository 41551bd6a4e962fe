//! A recorded trial, and whether it may judge.

use sistership_model::trial::Trial;

/// A recorded trial of the ship.
#[derive(Debug, Clone, Copy)]
pub struct TrialOfShip<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its samples.
    pub trial: &'a Trial,
    /// Whether the model was fitted on it: such a trial judges nothing.
    pub fitted: bool,
}
