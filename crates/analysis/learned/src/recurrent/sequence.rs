//! How a network is trained on sequences of states.

use serde::{Deserialize, Serialize};

use super::network::Shape;

/// What is to be small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loss {
    /// What simulated positions and velocities lack of the recorded ones: Eq. 24.
    States,
    /// What accelerations lack of differences of the recorded velocities: Eq. 17.
    Accelerations,
}

/// How a network is trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SequenceTraining {
    /// The network; its inputs follow from the motions.
    pub shape: Shape,
    /// What is to be small.
    pub loss: Loss,
    /// Samples of a sequence, of which those that fill the memory are given: Table 8's N_T.
    pub steps: usize,
    /// Samples from the start of a sequence to that of the next.
    pub hop: usize,
    /// How often every sequence is seen.
    pub epochs: usize,
    /// Sequences to a step.
    pub batch: usize,
    /// Length of the steps of Adam.
    pub rate: f64,
    /// Of every random number drawn.
    pub seed: u64,
}
