//! Training examples: the inputs known at an instant, and the track of the ship afterwards.

use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::state::{StateVector, at};

use super::ahead::ahead;
use super::axes::Axes;
use super::error::HorizonError;
use super::inputs::{Told, end, orders, present};

/// Settings of one-shot prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OneShot {
    /// Number of samples ahead.
    pub steps: usize,
    /// Encoding of the future orders.
    pub told: Told,
    /// Number of samples given to the network, including the present one.
    pub memory: usize,
}

/// Example at one instant of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
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

impl Example {
    /// Error of the foundation: recorded less predicted positions, m.
    pub fn lacking(&self) -> Vec<f64> {
        self.sailed.iter().zip(&self.foundation).map(|(sailed, drawn)| sailed - drawn).collect()
    }

    /// Distances from the recorded track at each sample ahead, m, where `added` is added to the
    /// foundation's positions.
    pub fn misses(&self, added: &[f64]) -> Vec<f64> {
        let off = |k: usize| self.foundation[k] + added[k] - self.sailed[k];
        // The first half is the distance ahead, the second half that to starboard.
        let steps = self.sailed.len() / 2;
        (0..steps).map(|k| off(k).hypot(off(steps + k))).collect()
    }
}

impl OneShot {
    /// Returns the examples of a trial, one every `hop` samples, none across a gap. Without a
    /// foundation the encoding by its end state adds no inputs.
    ///
    /// # Errors
    /// Returns the errors of the foundation's prediction.
    pub fn examples(
        &self,
        foundation: Option<&Ship>,
        trial: &Trial,
        hop: usize,
    ) -> Result<Vec<Example>, HorizonError> {
        let mut all = Vec::new();
        for segment in trial.segments() {
            // Instants with a full horizon within the segment.
            let known: Vec<usize> =
                (segment.start..segment.end.saturating_sub(self.steps)).collect();
            let drawn = match foundation {
                Some(ship) => ahead(ship, trial, &known, self.steps)?,
                None => vec![Vec::new(); known.len()],
            };
            let rows: Vec<Vec<f64>> = known
                .iter()
                .zip(&drawn)
                .map(|(k, drawn)| self.row(trial, *k, drawn))
                .collect::<Result<_, _>>()?;
            // At the start of a segment the memory is shorter: inputs do not cross a gap.
            for place in (0..known.len()).step_by(hop.max(1)) {
                let seen = (place + 1).saturating_sub(self.memory.max(1))..=place;
                let inputs = rows[seen].to_vec();
                all.push(self.example(trial, known[place], inputs, &drawn[place]));
            }
        }
        Ok(all)
    }

    /// Inputs of a network at one sample.
    fn row(
        &self,
        trial: &Trial,
        k: usize,
        drawn: &[StateVector],
    ) -> Result<Vec<f64>, HorizonError> {
        let mut row = present(trial, k);
        match (self.told, drawn.last()) {
            (Told::End, Some(last)) => row.extend(end(&Axes::of(&state(trial, k)), last)),
            (Told::Orders { parts }, _) => row.extend(orders(trial, k, self.steps, parts)),
            _ => {}
        }
        if row.iter().all(|value| value.is_finite()) {
            return Ok(row);
        }
        Err(HorizonError::NotANumber { trial: trial.name.clone(), t_s: trial.t_s[k] })
    }

    /// Example with its tracks in the ship's axes.
    fn example(
        &self,
        trial: &Trial,
        sample: usize,
        inputs: Vec<Vec<f64>>,
        drawn: &[StateVector],
    ) -> Example {
        let axes = Axes::of(&state(trial, sample));
        let sailed: Vec<StateVector> = (1..=self.steps).map(|k| state(trial, sample + k)).collect();
        let foundation =
            if drawn.is_empty() { vec![0.0; 2 * self.steps] } else { seen(&axes, drawn) };
        Example { sample, inputs, foundation, sailed: seen(&axes, &sailed) }
    }
}

/// Positions of some states, ahead and then to starboard.
fn seen(axes: &Axes, states: &[StateVector]) -> Vec<f64> {
    let all: Vec<[f64; 2]> = states.iter().map(|s| axes.seen(s[at::X], s[at::Y])).collect();
    let column = |place: usize| all.iter().map(move |position| position[place]);
    column(0).chain(column(1)).collect()
}

/// Recorded position and heading at a sample.
fn state(trial: &Trial, k: usize) -> StateVector {
    let mut state = StateVector::zeros();
    for (channel, place) in [(Channel::X, at::X), (Channel::Y, at::Y), (Channel::Psi, at::PSI)] {
        state[place] = trial.channel(channel).map_or(0.0, |column| column[k]);
    }
    state
}
