//! What a simulation of a trial gives.

use sistership_model::validity::Excursion;

use crate::envelope::Stopped;
use crate::state::Trajectory;

/// A simulated trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Simulated states at the recorded times, as the instruments would say them; after a
    /// divergence, until then only.
    pub track: Trajectory,
    /// Sample of the trial to which each state belongs.
    pub samples: Vec<usize>,
    /// Why the simulation stopped early, if it did.
    pub stopped: Option<Stopped>,
    /// Whether roll was simulated.
    pub has_roll: bool,
    /// How the motion left what the model's trials covered, if it did.
    pub outside: Option<Excursion>,
}

impl Replay {
    pub(crate) fn nothing(has_roll: bool) -> Self {
        Self {
            track: Trajectory::default(),
            samples: Vec::new(),
            stopped: None,
            has_roll,
            outside: None,
        }
    }
}
