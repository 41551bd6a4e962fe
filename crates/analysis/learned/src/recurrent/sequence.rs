//! Settings of training on sequences of states.

use serde::{Deserialize, Serialize};

use super::network::NetworkShape;

/// Loss that is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossKind {
    /// Squared differences of simulated and recorded positions and velocities: Eq. 24.
    States,
    /// Squared differences between accelerations and differences of the recorded velocities: Eq.
    /// 17.
    Accelerations,
}

/// Settings of the training of a network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SequenceTraining {
    /// Structure of the network; its number of inputs follows from the motions.
    pub shape: NetworkShape,
    /// Loss that is minimised.
    pub loss: LossKind,
    /// Number of samples of a sequence, including those given to fill the memory: Table 8's N_T.
    pub steps: usize,
    /// Number of samples between the starts of successive sequences.
    pub hop: usize,
    /// Number of passes over all sequences.
    pub epochs: usize,
    /// Number of sequences per step.
    pub batch: usize,
    /// Learning rate of Adam.
    pub rate: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}
