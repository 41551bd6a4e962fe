//! Result of the simulation of a trial.

use sistership_model::validity::Excursion;

use crate::envelope::SimulationStop;
use crate::state::Trajectory;

/// Simulated trial.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialReplay {
    /// Simulated readings of the instruments at the recorded times; after a divergence, until then
    /// only.
    pub track: Trajectory,
    /// Sample of the trial for each state.
    pub samples: Vec<usize>,
    /// Reason of an early stop, if any.
    pub stopped: Option<SimulationStop>,
    /// True if roll was simulated.
    pub has_roll: bool,
    /// Excursion from the range covered by the model's trials, if any.
    pub outside: Option<Excursion>,
}

impl TrialReplay {
    pub(crate) fn without_samples(has_roll: bool) -> Self {
        Self {
            track: Trajectory::default(),
            samples: Vec::new(),
            stopped: None,
            has_roll,
            outside: None,
        }
    }
}
