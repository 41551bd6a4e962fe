//! On which inputs a branch depends: how much its error rises where one of them is shuffled among
//! the samples (permutation importance: Breiman 2001, Sec. 10).

use serde::Serialize;
use sistership_model::branch::{Branch, Signal};
use sistership_model::coefficient::Axis;

use crate::dependence::rise;
use crate::draws::Draws;
use crate::rows::Row;
use crate::train::sample_of;
use crate::weights::Weights;

/// What an output owes to an input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Importance {
    /// The acceleration's axis.
    pub axis: Axis,
    /// The input.
    pub signal: Signal,
    /// Rise of the mean squared error, by the targets' variance.
    pub rise: f64,
}

/// What each output owes to each of its inputs, in their order. Rows that were not trained on tell
/// more.
pub fn importance(branch: &Branch, weights: &Weights, rows: &[Row], seed: u64) -> Vec<Importance> {
    let mut draws = Draws::new(seed, 0);
    let mut all = Vec::new();
    for (output, regressor) in branch.outputs.iter().zip(&weights.outputs) {
        let mut sample = sample_of(rows, output, branch.mode);
        for (place, input) in output.inputs.iter().enumerate() {
            // Targets are in deviations, whose variance is 1.
            let rise = rise(regressor, &mut sample, place, &mut draws);
            all.push(Importance { axis: output.axis, signal: input.signal, rise });
        }
    }
    all
}
