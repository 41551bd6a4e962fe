//! Refinements from stored statistics: three axes of 22 coefficients, four trials left out in turn,
//! 100 strengths of the prior.
#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use sistership_fleet::bulk::{AxisPrior, BulkPrior, BulkSettings, solve_path};
use sistership_fleet::statistics::{FORMAT, RegressionStatistics, TrialStatistics};
use sistership_model::coefficient::Axis;
use sistership_numerics::RegressionMoments;

const REGRESSORS: usize = 22;
const SAMPLES: usize = 1000;
const TRIALS: usize = 4;
const SHIPS: usize = 200;

fn names(axis: Axis) -> Vec<String> {
    (0..REGRESSORS).map(|k| format!("{axis}_{k}")).collect()
}

fn regression(rng: &mut impl RngExt, axes: &[Axis]) -> RegressionStatistics {
    let mut columns: Vec<Vec<f64>> = (0..REGRESSORS + axes.len())
        .map(|_| (0..SAMPLES).map(|_| rng.random_range(-1.0..1.0)).collect())
        .collect();
    for k in 0..SAMPLES {
        let explained: f64 = (0..REGRESSORS).map(|j| 0.1 * columns[j][k]).sum();
        columns[REGRESSORS..].iter_mut().for_each(|target| target[k] += explained);
    }
    let unit =
        |row: usize| (0..axes.len()).map(|column| if row == column { 1.0 } else { 0.1 }).collect();
    RegressionStatistics {
        axes: axes.to_vec(),
        names: axes.iter().map(|axis| names(*axis)).collect(),
        shrinkage: vec![1.0; REGRESSORS],
        mixing: (0..axes.len()).map(unit).collect(),
        moments: RegressionMoments::from_columns(&columns, REGRESSORS),
    }
}

fn trial(rng: &mut impl RngExt) -> TrialStatistics {
    let regressions = vec![regression(rng, &[Axis::X]), regression(rng, &[Axis::Y, Axis::N])];
    TrialStatistics { format: FORMAT.into(), duration_s: 1000.0, regressions }
}

fn family() -> Vec<AxisPrior> {
    let one = |axis: Axis| {
        let root =
            DMatrix::from_fn(REGRESSORS, REGRESSORS, |i, j| if i == j { 0.05 } else { 0.002 });
        AxisPrior { names: names(axis), mean: vec![0.1; REGRESSORS], root }
    };
    vec![one(Axis::X), one(Axis::Y), one(Axis::N)]
}

fn bench(criterion: &mut Criterion) {
    let mut rng = rand_chacha::ChaCha12Rng::seed_from_u64(1);
    let ships: Vec<Vec<TrialStatistics>> =
        (0..SHIPS).map(|_| (0..TRIALS).map(|_| trial(&mut rng)).collect()).collect();
    let source = [Axis::X, Axis::Y, Axis::N]
        .iter()
        .flat_map(|axis| names(*axis))
        .map(|name| (name, 0.08))
        .collect();
    let family = family();
    let settings = BulkSettings::default();
    let mut group =
        criterion.benchmark_group("refine 3 axes x 22 coefficients from 4 trials, 100 strengths");
    for (name, prior) in [
        ("source", BulkPrior::Source(&source)),
        ("family", BulkPrior::Family { axes: &family, design_effect: 1.0 }),
    ] {
        let one = |trials: &Vec<TrialStatistics>| {
            solve_path(trials, prior, &settings).map(|solved| solved.coefficients_at(0).0)
        };
        group.throughput(Throughput::Elements(1));
        group
            .bench_function(format!("{name}, one core"), |bencher| bencher.iter(|| one(&ships[0])));
        group.throughput(Throughput::Elements(SHIPS as u64));
        group.bench_function(format!("{name}, {SHIPS} ships on all cores"), |bencher| {
            bencher.iter(|| ships.par_iter().map(one).collect::<Result<Vec<_>, _>>());
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
