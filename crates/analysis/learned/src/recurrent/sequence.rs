//! Settings of training on sequences of states.

use serde::{Deserialize, Serialize};

use super::network::{NetworkMemory, NetworkShape};
use crate::setting_error::SettingError;

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

impl SequenceTraining {
    /// Checks the settings.
    ///
    /// # Errors
    /// Returns the first setting that is out of range, with the permitted range.
    pub fn check_settings(&self) -> Result<(), SettingError> {
        let of_steps = "should be from 1 to 10000";
        SettingError::refuse_unless((1..=10_000).contains(&self.steps), "steps", of_steps)?;
        SettingError::refuse_unless(self.hop >= 1, "hop", "should be at least 1")?;
        SettingError::check_epochs(self.epochs)?;
        SettingError::check_batch(self.batch)?;
        SettingError::check_rate(self.rate)?;
        self.check_shape()
    }

    fn check_shape(&self) -> Result<(), SettingError> {
        SettingError::check_width(self.shape.width)?;
        let of_outputs = "should be 3, the accelerations of surge, sway and yaw";
        SettingError::refuse_unless(self.shape.outputs == 3, "outputs", of_outputs)?;
        // The last step of a sequence must be one that the network sees with a full memory.
        let fits = match self.shape.memory {
            NetworkMemory::Steps(steps) => (1..=self.steps).contains(&steps),
            NetworkMemory::All => true,
        };
        SettingError::refuse_unless(
            fits,
            "memory",
            "should be `all`, or from 1 to the number of `steps`",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::cell::RecurrentCell;
    use super::*;

    fn training() -> SequenceTraining {
        let (cell, memory) = (RecurrentCell::Rnn, NetworkMemory::Steps(3));
        SequenceTraining {
            shape: NetworkShape { cell, memory, inputs: 0, width: 4, outputs: 3 },
            loss: LossKind::States,
            steps: 12,
            hop: 5,
            epochs: 2,
            batch: 4,
            rate: 0.01,
            seed: 3,
        }
    }

    /// Field under which the changed settings are refused.
    fn refused_field(change: impl Fn(&mut SequenceTraining)) -> Option<&'static str> {
        let mut changed = training();
        change(&mut changed);
        changed.check_settings().err().map(|error| error.field)
    }

    #[test]
    fn settings_out_of_range_are_refused_by_field() {
        assert_eq!(training().check_settings(), Ok(()));
        assert_eq!(refused_field(|one| one.batch = 0), Some("batch"));
        assert_eq!(refused_field(|one| one.hop = 0), Some("hop"));
        assert_eq!(refused_field(|one| one.steps = 0), Some("steps"));
        assert_eq!(refused_field(|one| one.rate = f64::NAN), Some("rate"));
        assert_eq!(refused_field(|one| one.epochs = 100_001), Some("epochs"));
        assert_eq!(refused_field(|one| one.shape.width = 0), Some("width"));
        assert_eq!(refused_field(|one| one.shape.outputs = 2), Some("outputs"));
        for memory in [0, 13] {
            let field = refused_field(|one| one.shape.memory = NetworkMemory::Steps(memory));
            assert_eq!(field, Some("memory"), "{memory}");
        }
        assert_eq!(refused_field(|one| one.shape.memory = NetworkMemory::Steps(12)), None);
    }
}
