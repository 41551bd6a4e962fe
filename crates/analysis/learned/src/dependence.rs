//! Dependence of a regressor on its inputs: the rise of its error where an input is shuffled among
//! the samples (permutation importance: Breiman 2001, Sec. 10), and its mean over the samples where
//! an input is fixed (partial dependence: Friedman 2001, Ann Stat 29, 1189-1232; `f(x) = 1/n sum_i
//! f(x, x_iC)`).

use sistership_model::branch::Learner;

use crate::draws::RandomStream;
use crate::regressor::OutputRegressor;
use crate::sample::{TrainingSample, centre_and_scale};

/// Dependence of a target on its inputs, evaluated on samples that were not used in training.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnedDependence {
    /// Share of the target's variance that is explained there; negative if the mean explains more.
    pub explained: f64,
    /// Dependence on each input, in their order.
    pub inputs: Vec<InputDependence>,
}

/// Dependence of a prediction on one input.
#[derive(Debug, Clone, PartialEq)]
pub struct InputDependence {
    /// Rise of the mean squared error where the input is shuffled, divided by the target's
    /// variance.
    pub rise: f64,
    /// Values of the input, increasing, in its unit.
    pub at: Vec<f64>,
    /// Mean prediction with the input fixed at each of these values, in the target's unit.
    pub answer: Vec<f64>,
}

/// Trains a regressor on `seen` and evaluates its dependence on the inputs on `unseen`, each input
/// at `points` of its quantiles. Returns `None` if there are no samples or the equations are
/// singular.
pub fn learn_dependence(
    learner: &Learner,
    seen: &TrainingSample,
    unseen: &TrainingSample,
    points: usize,
    seed: u64,
) -> Option<LearnedDependence> {
    if seen.is_empty() || unseen.is_empty() {
        return None;
    }
    let scales: Vec<(f64, f64)> = seen.columns.iter().map(|c| centre_and_scale(c)).collect();
    let of_target = centre_and_scale(&seen.targets);
    let regressor =
        OutputRegressor::train_output(learner, &scale_sample(seen, &scales, of_target), seed, 0)?;
    // Unseen samples are scaled by the seen ones, as the regressor expects.
    let mut judged = scale_sample(unseen, &scales, of_target);
    let (_, deviation) = centre_and_scale(&judged.targets);
    let explained = 1.0 - mean_squared_error(&regressor, &judged) / deviation.powi(2);
    let mut draws = RandomStream::new(seed, 1);
    let inputs = (0..scales.len()).map(|place| {
        // Relative to the variance of the unseen targets, as the share explained is.
        let rise =
            shuffled_error_rise(&regressor, &mut judged, place, &mut draws) / deviation.powi(2);
        let at = class_medians(&unseen.columns[place], points);
        let (centre, scale) = scales[place];
        let held = |x: &f64| partial_dependence(&regressor, &judged, place, (x - centre) / scale);
        let answer = at.iter().map(|x| of_target.0 + of_target.1 * held(x)).collect();
        InputDependence { rise, at, answer }
    });
    Some(LearnedDependence { explained, inputs: inputs.collect() })
}

/// Rise of the mean squared error of a regressor where an input is shuffled among the samples. The
/// sample is restored afterwards.
pub(crate) fn shuffled_error_rise(
    regressor: &OutputRegressor,
    sample: &mut TrainingSample,
    place: usize,
    draws: &mut RandomStream,
) -> f64 {
    let before = mean_squared_error(regressor, sample);
    let order = draws.sample_indices(sample.len(), sample.len());
    let shuffled = order.iter().map(|k| sample.columns[place][*k as usize]).collect();
    let own = std::mem::replace(&mut sample.columns[place], shuffled);
    let rise = mean_squared_error(regressor, sample) - before;
    sample.columns[place] = own;
    rise
}

/// Mean squared error of a regressor.
fn mean_squared_error(regressor: &OutputRegressor, sample: &TrainingSample) -> f64 {
    let of = |k: usize| (regressor.predict(&sample.row_inputs(k)) - sample.targets[k]).powi(2);
    (0..sample.len()).map(of).sum::<f64>() / sample.len() as f64
}

/// Partial dependence: the mean prediction over the samples with an input fixed at a value.
fn partial_dependence(
    regressor: &OutputRegressor,
    sample: &TrainingSample,
    place: usize,
    value: f64,
) -> f64 {
    let of = |k: usize| {
        let mut row = sample.row_inputs(k);
        row[place] = value;
        regressor.predict(&row)
    };
    (0..sample.len()).map(of).sum::<f64>() / sample.len() as f64
}

/// Sample in standard deviations from given centres.
fn scale_sample(
    sample: &TrainingSample,
    scales: &[(f64, f64)],
    of_target: (f64, f64),
) -> TrainingSample {
    let by = |values: &[f64], (centre, scale): (f64, f64)| {
        values.iter().map(|x| (x - centre) / scale).collect::<Vec<f64>>()
    };
    let columns = sample.columns.iter().zip(scales).map(|(column, scale)| by(column, *scale));
    TrainingSample { columns: columns.collect(), targets: by(&sample.targets, of_target) }
}

/// Medians of `points` classes of equal count, without repetition.
fn class_medians(values: &[f64], points: usize) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = |k: usize| sorted[(2 * k + 1) * sorted.len() / (2 * points)];
    let mut all: Vec<f64> = (0..points).map(middle).collect();
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A target that is twice the square of the first input; the second has nothing to do with it.
    fn samples(seed: u64) -> TrainingSample {
        let mut draws = RandomStream::new(seed, 0);
        let mut column = || (0..400).map(|_| draws.signed_unit()).collect::<Vec<f64>>();
        let columns = vec![column(), column()];
        let targets = columns[0].iter().map(|x| 10.0 + 2.0 * x * x).collect();
        TrainingSample { columns, targets }
    }

    #[test]
    fn the_input_that_matters_and_its_curve_are_told() {
        let learner = Learner::RandomForest { trees: 30, tried: 2, leaf: 5, depth: 6 };
        let told = learn_dependence(&learner, &samples(1), &samples(2), 9, 7).unwrap();
        assert!(told.explained > 0.9, "{}", told.explained);
        let [first, second] = &told.inputs[..] else { panic!("two inputs") };
        assert!(first.rise > 1.0 && second.rise.abs() < 0.05, "{told:?}");
        for (x, y) in first.at.iter().zip(&first.answer) {
            assert!((y - (10.0 + 2.0 * x * x)).abs() < 0.15, "{x}: {y}");
        }
        assert_eq!(told, learn_dependence(&learner, &samples(1), &samples(2), 9, 7).unwrap());
    }

    #[test]
    fn nothing_is_told_of_nothing() {
        let learner = Learner::RandomForest { trees: 3, tried: 1, leaf: 5, depth: 3 };
        let none = TrainingSample { columns: vec![Vec::new()], targets: Vec::new() };
        assert_eq!(learn_dependence(&learner, &none, &none, 3, 1), None);
    }
}
