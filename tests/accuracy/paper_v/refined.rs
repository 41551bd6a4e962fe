//! Model refinement: Paper V, section 3.3, on the data sets of section 4.2.

use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use sistership_identification::refine::{
    RegressionBlocks, RegressionFold, RegressionTable, TuningRange, fit_regressions, trial_tables,
    tune_choices,
};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_numerics::RegressionMoments;
use sistership_simulation::Trajectory;
use sistership_simulation::state::at;
use sistership_trials::smoothing::savitzky_golay;

use super::truth::{FITTED, Truth, recorded};

/// Rudder and heading of the zigzag in each of the five data sets, deg.
pub const ZIGZAGS: [(f64, f64); 5] =
    [(10.0, 10.0), (10.0, 5.0), (12.5, 10.0), (5.0, 5.0), (12.5, 15.0)];
/// Rudder of the turns that are in every data set, deg.
pub const TURNS: [f64; 2] = [12.5, -12.5];
/// Standard deviations of the noise, m/s and rad/s: amplitude, reduction by channel and general
/// reduction of Eq. 22.
pub const NOISE: [(Channel, usize, f64); 3] = [
    (Channel::U, at::U, 8.0 * 0.1 * 0.003),
    (Channel::V, at::V, 1.0 * 0.003),
    (Channel::R, at::R, 1.0 * 0.003 * std::f64::consts::PI / 180.0),
];
/// Window and degree of the Savitzky-Golay filter; the paper gives none.
const SMOOTHING: (usize, usize) = (21, 3);
/// Where lambda and alpha are tuned; the paper prints 10 for the least lambda, its results say
/// 10^0.
const RANGE: TuningRange = TuningRange { lambda_min: 1.0, lambda_max: 1e10, alpha_max: 0.1 };
/// Values of lambda tried.
const LAMBDAS: usize = 100;
/// Share of the samples that is fitted while tuning.
const TRAINING: f64 = 0.7;

/// The source refined on each of five data sets.
pub fn refinements(source: &Model, law: &Law, truth: &Truth, rng: &mut ChaCha8Rng) -> Vec<Model> {
    let blocks = RegressionBlocks::new(source, law).expect("a law that can be regressed");
    let turns = TURNS.map(|rudder_deg| truth.turn(rudder_deg));
    let one = |(rudder_deg, heading_deg): (f64, f64)| {
        let [starboard, port] = &turns;
        let trials = [&truth.zigzag(rudder_deg, heading_deg), starboard, port]
            .map(|track| measured(track, rng));
        refined(source, &blocks, &trials, rng)
    };
    ZIGZAGS.into_iter().map(one).collect()
}

/// Tuned by the one-step error on samples kept back, then fitted on all of them.
fn refined(
    source: &Model,
    blocks: &RegressionBlocks,
    trials: &[Trial],
    rng: &mut ChaCha8Rng,
) -> Model {
    let tables = samples(blocks, trials);
    let (training, validation) = split(&tables, rng);
    let fold = RegressionFold::new(
        blocks,
        source,
        &moments(blocks, &training),
        &moments(blocks, &validation),
    );
    let choices = tune_choices(&[fold], &RANGE, LAMBDAS).expect("finite errors");
    let fit = fit_regressions(blocks, &moments(blocks, &tables), source, &choices);
    let mut model = source.clone();
    model.coefficients.extend(
        fit.coefficients
            .into_iter()
            .map(|(name, fitted)| (name, Quantity::new(fitted.value, "refined"))),
    );
    model
}

/// What is recorded with noise and smoothed before the straight run is cut off; the rudder is
/// recorded as it is.
fn measured(track: &Trajectory, rng: &mut ChaCha8Rng) -> Trial {
    let mut trial = recorded(track, FITTED);
    for (channel, index, deviation) in NOISE {
        trial.channels.insert(channel, noisy(track, index, deviation, rng));
    }
    trial
}

/// A state as measured: with noise, smoothed, without the straight run before.
pub fn noisy(track: &Trajectory, index: usize, deviation: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let noise = Normal::new(0.0, deviation).expect("a finite deviation");
    let noisy: Vec<f64> =
        track.state_column(index).into_iter().map(|value| value + noise.sample(rng)).collect();
    let smooth =
        savitzky_golay(&noisy, SMOOTHING.0, SMOOTHING.1).expect("a record longer than the window");
    smooth[FITTED].to_vec()
}

/// One table for each regression over the samples of all trials.
fn samples(blocks: &RegressionBlocks, trials: &[Trial]) -> Vec<RegressionTable> {
    let tables = trials.iter().map(|trial| {
        trial_tables(blocks, trial, None, &|_, _| 0.0).expect("every channel that the law needs")
    });
    let append = |mut all: Vec<RegressionTable>, more: Vec<RegressionTable>| {
        all.iter_mut()
            .flatten()
            .zip(more.iter().flatten())
            .for_each(|(column, more)| column.extend(more));
        all
    };
    tables.reduce(append).expect("at least one trial")
}

/// Samples drawn at random for training, and the rest.
fn split(
    tables: &[RegressionTable],
    rng: &mut ChaCha8Rng,
) -> (Vec<RegressionTable>, Vec<RegressionTable>) {
    let mut rows: Vec<usize> = (0..tables[0][0].len()).collect();
    rows.shuffle(rng);
    let (training, validation) = rows.split_at((TRAINING * rows.len() as f64).round() as usize);
    let keep = |rows: &[usize]| -> Vec<RegressionTable> {
        let column = |column: &Vec<f64>| rows.iter().map(|&row| column[row]).collect();
        tables.iter().map(|table| table.iter().map(column).collect()).collect()
    };
    (keep(training), keep(validation))
}

fn moments(blocks: &RegressionBlocks, tables: &[RegressionTable]) -> Vec<RegressionMoments> {
    blocks
        .blocks
        .iter()
        .zip(tables)
        .map(|(block, table)| RegressionMoments::from_columns(table, block.regressor_count()))
        .collect()
}
