//! What is learned from: what was known at an instant, and where the ship then went.

use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;
use sistership_simulation::state::{StateVector, at};

use super::ahead::ahead;
use super::axes::Axes;
use super::error::HorizonError;
use super::inputs::{Told, end, orders, present};

/// How predictions are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OneShot {
    /// Samples ahead.
    pub steps: usize,
    /// What stands for the orders to come.
    pub told: Told,
    /// Samples of which a network is told, the present one among them.
    pub memory: usize,
}

/// An instant of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// The sample.
    pub sample: usize,
    /// What was known at it and before, the oldest first.
    pub inputs: Vec<Vec<f64>>,
    /// The foundation's positions ahead, then those to starboard, m; zeros without a foundation.
    pub foundation: Vec<f64>,
    /// The ship's, in the same order, m.
    pub sailed: Vec<f64>,
}

impl Example {
    /// What the foundation lacks, m.
    pub fn lacking(&self) -> Vec<f64> {
        self.sailed.iter().zip(&self.foundation).map(|(sailed, drawn)| sailed - drawn).collect()
    }

    /// Distances from where the ship went, at each sample ahead, m; `added` is put to what the
    /// foundation drew.
    pub fn misses(&self, added: &[f64]) -> Vec<f64> {
        let off = |k: usize| self.foundation[k] + added[k] - self.sailed[k];
        let steps = self.sailed.len() / 2;
        (0..steps).map(|k| off(k).hypot(off(steps + k))).collect()
    }
}

impl OneShot {
    /// The examples of a trial, one every so many samples, none across a gap. Without a foundation
    /// [`Told::End`] tells nothing.
    ///
    /// # Errors
    /// As [`ahead`].
    pub fn examples(
        &self,
        foundation: Option<&Ship>,
        trial: &Trial,
        hop: usize,
    ) -> Result<Vec<Example>, HorizonError> {
        let mut all = Vec::new();
        for segment in trial.segments() {
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
            for place in (0..known.len()).step_by(hop.max(1)) {
                let seen = (place + 1).saturating_sub(self.memory.max(1))..=place;
                let inputs = rows[seen].to_vec();
                all.push(self.example(trial, known[place], inputs, &drawn[place]));
            }
        }
        Ok(all)
    }

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

/// Positions ahead, then those to starboard.
fn seen(axes: &Axes, states: &[StateVector]) -> Vec<f64> {
    let all: Vec<[f64; 2]> = states.iter().map(|s| axes.seen(s[at::X], s[at::Y])).collect();
    let column = |place: usize| all.iter().map(move |position| position[place]);
    column(0).chain(column(1)).collect()
}

/// Position and heading at a sample.
fn state(trial: &Trial, k: usize) -> StateVector {
    let mut state = StateVector::zeros();
    for (channel, place) in [(Channel::X, at::X), (Channel::Y, at::Y), (Channel::Psi, at::PSI)] {
        state[place] = trial.channel(channel).map_or(0.0, |column| column[k]);
    }
    state
}
