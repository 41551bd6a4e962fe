//! Training examples: the inputs known at an instant, and the track of the ship afterwards.

use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::state::{StateVector, at};

use super::ahead::predict_tracks;
use super::axes::ShipAxes;
use super::error::HorizonError;
use super::inputs::{OrderEncoding, end_state, mean_orders, present_inputs};
use crate::setting_error::SettingError;

/// Settings of one-shot prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OneShotSettings {
    /// Number of samples ahead.
    pub steps: usize,
    /// Encoding of the future orders.
    pub told: OrderEncoding,
    /// Number of samples given to the network, including the present one.
    pub memory: usize,
}

/// Example at one instant of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackExample {
    /// Index of the sample.
    pub sample: usize,
    /// Inputs at the sample and before, oldest first.
    pub inputs: Vec<Vec<f64>>,
    /// Positions predicted by the foundation, ahead and then to starboard, m; zeros without a
    /// foundation.
    pub foundation: Vec<f64>,
    /// Recorded positions in the same order, m.
    pub sailed: Vec<f64>,
}

impl TrackExample {
    /// Error of the foundation: recorded less predicted positions, m.
    pub fn foundation_error(&self) -> Vec<f64> {
        self.sailed.iter().zip(&self.foundation).map(|(sailed, drawn)| sailed - drawn).collect()
    }

    /// Distances from the recorded track at each sample ahead, m, where `added` is added to the
    /// foundation's positions.
    pub fn position_errors(&self, added: &[f64]) -> Vec<f64> {
        let off = |k: usize| self.foundation[k] + added[k] - self.sailed[k];
        // The first half is the distance ahead, the second half that to starboard.
        let steps = self.sailed.len() / 2;
        (0..steps).map(|k| off(k).hypot(off(steps + k))).collect()
    }
}

impl OneShotSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// Returns the first setting that is out of range, with the permitted range.
    pub fn check_settings(&self) -> Result<(), SettingError> {
        let of_steps = "should be from 1 to 10000";
        SettingError::refuse_unless((1..=10_000).contains(&self.steps), "steps", of_steps)?;
        SettingError::refuse_unless(self.memory >= 1, "memory", "should be at least 1")?;
        let divides = match self.told {
            OrderEncoding::Orders { parts } => (1..=self.steps).contains(&parts),
            OrderEncoding::End | OrderEncoding::Nothing => true,
        };
        SettingError::refuse_unless(divides, "parts", "should be from 1 to the number of `steps`")
    }

    /// Returns the examples of a trial, one every `hop` samples, none across a gap. Without a
    /// foundation the encoding by its end state adds no inputs.
    ///
    /// # Errors
    /// Returns a setting that is out of range, or the errors of the foundation's prediction.
    pub fn trial_examples(
        &self,
        foundation: Option<&Ship>,
        trial: &Trial,
        hop: usize,
    ) -> Result<Vec<TrackExample>, HorizonError> {
        self.check_settings()?;
        SettingError::refuse_unless(hop >= 1, "hop", "should be at least 1")?;
        let mut all = Vec::new();
        for segment in trial.segments() {
            // Instants with a full horizon within the segment.
            let known: Vec<usize> =
                (segment.start..segment.end.saturating_sub(self.steps)).collect();
            let drawn = match foundation {
                Some(ship) => predict_tracks(ship, trial, &known, self.steps)?,
                None => vec![Vec::new(); known.len()],
            };
            let rows: Vec<Vec<f64>> = known
                .iter()
                .zip(&drawn)
                .map(|(k, drawn)| self.input_row(trial, *k, drawn))
                .collect::<Result<_, _>>()?;
            // At the start of a segment the memory is shorter: inputs do not cross a gap.
            for place in (0..known.len()).step_by(hop) {
                let seen = (place + 1).saturating_sub(self.memory)..=place;
                let inputs = rows[seen].to_vec();
                all.push(self.example_at(trial, known[place], inputs, &drawn[place]));
            }
        }
        Ok(all)
    }

    /// Inputs of a network at one sample.
    fn input_row(
        &self,
        trial: &Trial,
        k: usize,
        drawn: &[StateVector],
    ) -> Result<Vec<f64>, HorizonError> {
        let mut row = present_inputs(trial, k);
        match (self.told, drawn.last()) {
            (OrderEncoding::End, Some(last)) => {
                row.extend(end_state(&ShipAxes::from_state(&recorded_pose(trial, k)), last))
            }
            (OrderEncoding::Orders { parts }, _) => {
                row.extend(mean_orders(trial, k, self.steps, parts))
            }
            _ => {}
        }
        if row.iter().all(|value| value.is_finite()) {
            return Ok(row);
        }
        Err(HorizonError::NotANumber { trial: trial.name.clone(), t_s: trial.t_s[k] })
    }

    /// Example with its tracks in the ship's axes.
    fn example_at(
        &self,
        trial: &Trial,
        sample: usize,
        inputs: Vec<Vec<f64>>,
        drawn: &[StateVector],
    ) -> TrackExample {
        let axes = ShipAxes::from_state(&recorded_pose(trial, sample));
        let sailed: Vec<StateVector> =
            (1..=self.steps).map(|k| recorded_pose(trial, sample + k)).collect();
        let foundation = if drawn.is_empty() {
            vec![0.0; 2 * self.steps]
        } else {
            relative_positions(&axes, drawn)
        };
        TrackExample { sample, inputs, foundation, sailed: relative_positions(&axes, &sailed) }
    }
}

/// Positions of some states, ahead and then to starboard.
fn relative_positions(axes: &ShipAxes, states: &[StateVector]) -> Vec<f64> {
    let all: Vec<[f64; 2]> = states.iter().map(|s| axes.to_ship_axes(s[at::X], s[at::Y])).collect();
    let column = |place: usize| all.iter().map(move |position| position[place]);
    column(0).chain(column(1)).collect()
}

/// Recorded position and heading at a sample.
fn recorded_pose(trial: &Trial, k: usize) -> StateVector {
    let mut state = StateVector::zeros();
    for (channel, place) in [(Channel::X, at::X), (Channel::Y, at::Y), (Channel::Psi, at::PSI)] {
        state[place] = trial.channel(channel).map_or(0.0, |column| column[k]);
    }
    state
}
