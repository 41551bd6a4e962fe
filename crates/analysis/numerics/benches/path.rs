//! One refinement: three axes, 22 regressors, 5000 samples, 100 values of lambda, five folds, on
//! one core.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use sistership_numerics::{
    AlphaError, RegressionMoments, RidgeChoice, RidgePath, ValidationSamples,
};

const REGRESSORS: usize = 22;
const SAMPLES: usize = 5000;
const FOLDS: usize = 5;
const LAMBDAS: usize = 100;

/// Columns of one axis group: regressors, then as many targets as axes share them.
fn columns(rng: &mut impl RngExt, targets: usize) -> Vec<Vec<f64>> {
    (0..REGRESSORS + targets)
        .map(|_| (0..SAMPLES).map(|_| rng.random_range(-1.0..1.0)).collect())
        .collect()
}

/// From samples to coefficients: statistics of each fold, the whole path on the others, and the fit
/// on all.
fn refine(columns: &[Vec<f64>], source: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let size = SAMPLES / FOLDS;
    let slice = |fold: usize| {
        columns
            .iter()
            .map(|column| column[fold * size..(fold + 1) * size].to_vec())
            .collect::<Vec<_>>()
    };
    let parts: Vec<RegressionMoments> =
        (0..FOLDS).map(|fold| RegressionMoments::from_columns(&slice(fold), REGRESSORS)).collect();
    let folds: Vec<(RidgePath, ValidationSamples)> = (0..FOLDS)
        .map(|out| {
            let rest =
                parts.iter().enumerate().filter(|(fold, _)| *fold != out).map(|(_, part)| part);
            let training = RegressionMoments::merge_all(rest).expect("four folds");
            (RidgePath::new(&training, source), ValidationSamples::new(&parts[out]))
        })
        .collect();
    let whole = RidgePath::new(&RegressionMoments::merge_all(&parts).expect("five folds"), source);
    (0..source.len())
        .map(|target| {
            whole.solve_target(target, best(&folds, target, &source[target]), &source[target])
        })
        .collect()
}

fn best(folds: &[(RidgePath, ValidationSamples)], target: usize, source: &[f64]) -> RidgeChoice {
    let mut best = (f64::INFINITY, RidgeChoice { lambda: 1.0, alpha: 0.0 });
    for k in 0..LAMBDAS {
        let lambda = 10_f64.powf(-6.0 + 16.0 * k as f64 / (LAMBDAS - 1) as f64);
        let of_fold = |(path, validation): &(RidgePath, ValidationSamples)| {
            path.error_by_alpha(target, lambda, source, validation)
        };
        let (alpha, error) = folds.iter().map(of_fold).sum::<AlphaError>().least_error(0.1);
        if error < best.0 {
            best = (error, RidgeChoice { lambda, alpha });
        }
    }
    best.1
}

fn bench(criterion: &mut Criterion) {
    let mut rng = rand_chacha::ChaCha12Rng::seed_from_u64(1);
    let (surge, lateral) = (columns(&mut rng, 1), columns(&mut rng, 2));
    let source = |targets: usize| vec![vec![0.1; REGRESSORS]; targets];
    criterion.bench_function(
        "refine 3 axes x 22 regressors, 5000 samples, 100 lambdas, 5 folds",
        |bencher| {
            bencher.iter(|| (refine(&surge, &source(1)), refine(&lateral, &source(2))));
        },
    );
}

criterion_group!(benches, bench);
criterion_main!(benches);
