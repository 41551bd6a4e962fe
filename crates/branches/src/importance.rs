//! On which inputs a branch depends: how much its error rises where one of them is shuffled among
//! the samples (permutation importance: Breiman 2001, Sec. 10).

use serde::Serialize;
use sistership_model::branch::{Branch, Signal};
use sistership_model::coefficient::Axis;

use crate::draws::Draws;
use crate::rows::Row;
use crate::sample::Sample;
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
        let error = |sample: &Sample| -> f64 {
            let of = |k: usize| (regressor.answer(&sample.row(k)) - sample.targets[k]).powi(2);
            (0..sample.len()).map(of).sum::<f64>() / sample.len() as f64
        };
        let before = error(&sample);
        for (place, input) in output.inputs.iter().enumerate() {
            let order = draws.some_of(sample.len(), sample.len());
            let shuffled = order.iter().map(|k| sample.columns[place][*k as usize]).collect();
            let own = std::mem::replace(&mut sample.columns[place], shuffled);
            // Targets are in deviations, whose variance is 1.
            let rise = error(&sample) - before;
            sample.columns[place] = own;
            all.push(Importance { axis: output.axis, signal: input.signal, rise });
        }
    }
    all
}
