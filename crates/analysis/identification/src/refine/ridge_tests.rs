#![allow(clippy::unwrap_used)]
use sistership_model::Zoo;

use super::*;

/// One axis, its forces regressed on two terms.
fn blocks() -> (RegressionBlocks, Model) {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    model.coefficients.retain(|name, _| ["X_u", "X_vv"].contains(&name.as_str()));
    model.coefficients.get_mut("X_u").unwrap().value = 3.0;
    model.coefficients.get_mut("X_vv").unwrap().value = -2.0;
    let mut blocks = RegressionBlocks::new(&model, zoo.law("abkowitz").unwrap()).unwrap();
    blocks.blocks.retain(|block| block.axes == [Axis::X]);
    (blocks, model)
}

/// Rows of a fold: of each, the terms move by another size, and the truth is another.
fn table(fold: usize) -> Vec<Vec<f64>> {
    let column =
        |f: &dyn Fn(f64) -> f64| (0..80).map(|k| f((k + 13 * fold) as f64)).collect::<Vec<f64>>();
    let size = [0.3, 1.0, 4.0][fold];
    let (a, b) = (column(&|k| size * (0.31 * k).sin()), column(&|k| (0.17 * k).cos() / size));
    let truth = [[0.5, -0.2], [2.6, -1.9], [1.2, -3.0]][fold];
    let noise = column(&|k| 0.2 * (5.1 * k).sin());
    let y = (0..80).map(|k| truth[0] * a[k] + truth[1] * b[k] + noise[k]).collect();
    vec![a, b, y]
}

/// Each of the folds held out, with the moments of the others.
fn folds<'a>(blocks: &'a RegressionBlocks, model: &Model) -> Vec<RegressionFold<'a>> {
    let moments: Vec<RegressionMoments> =
        (0..3).map(|k| RegressionMoments::about_zero(&table(k), 2, 1.0)).collect();
    let one = |held_out: usize| {
        let others = (0..3).filter(|other| *other != held_out).map(|other| &moments[other]);
        let training = RegressionMoments::merge_all(others).unwrap();
        RegressionFold::new(blocks, model, &[training], &[moments[held_out].clone()])
    };
    (0..3).map(one).collect()
}

/// The sum over the folds of the mean square of what is left, sample by sample.
fn error(folds: &[RegressionFold<'_>], choice: RidgeChoice) -> f64 {
    let of_fold = |(held_out, fold): (usize, &RegressionFold<'_>)| {
        let solved = fold.solve(&vec![vec![choice]]);
        let [a, b, y] = <[Vec<f64>; 3]>::try_from(table(held_out)).unwrap();
        let left = |k: usize| y[k] - solved["X_u"].value * a[k] - solved["X_vv"].value * b[k];
        (0..80).map(|k| left(k).powi(2)).sum::<f64>() / 80.0
    };
    folds.iter().enumerate().map(of_fold).sum()
}

const RANGE: TuningRange = TuningRange { lambda_min: 1e-2, lambda_max: 1e2, alpha_max: 1.0 };
const COUNT: usize = 9;

#[test]
fn a_choice_has_the_least_error_over_all_folds_together() {
    let (blocks, model) = blocks();
    let folds = folds(&blocks, &model);
    let tuned = tune_choices(&folds, &RANGE, COUNT).unwrap()[0][0];
    let least = error(&folds, tuned);
    for lambda in log_spaced(RANGE.lambda_min, RANGE.lambda_max, COUNT) {
        for step in 0..=50 {
            let other = RidgeChoice { lambda, alpha: 0.02 * f64::from(step) };
            assert!(least <= error(&folds, other) + 1e-12, "{tuned:?} not {other:?}");
        }
    }
}

/// What each fold would choose alone is another alpha, and their mean leaves more.
#[test]
fn the_mean_of_the_choices_of_each_fold_is_another() {
    let (blocks, model) = blocks();
    let folds = folds(&blocks, &model);
    let lambda = tune_choices(&folds, &RANGE, COUNT).unwrap()[0][0].lambda;
    let at = |folds: &[RegressionFold<'_>]| {
        let only = TuningRange { lambda_min: lambda, lambda_max: lambda, alpha_max: 1.0 };
        tune_choices(folds, &only, 2).unwrap()[0][0]
    };
    let together = at(&folds);
    let mean = folds.chunks(1).map(|fold| at(fold).alpha).sum::<f64>() / 3.0;
    let of_mean = error(&folds, RidgeChoice { lambda, alpha: mean });
    assert!(of_mean > 1.001 * error(&folds, together), "{mean} and {together:?}");
}

#[test]
fn samples_that_are_not_finite_are_refused_by_their_axis() {
    let (blocks, model) = blocks();
    let good = RegressionMoments::about_zero(&table(0), 2, 1.0);
    let mut columns = table(1);
    columns[2][7] = f64::NAN;
    let bad = RegressionMoments::about_zero(&columns, 2, 1.0);
    let folds = [RegressionFold::new(&blocks, &model, &[good], &[bad])];
    let refusal = tune_choices(&folds, &RANGE, COUNT).unwrap_err().to_string();
    assert!(refusal.contains("of the X axis is not finite"), "{refusal}");
}

#[test]
fn strengths_are_even_in_their_logarithm() {
    let all: Vec<f64> = log_spaced(1e-2, 1e2, 5).collect();
    let expected = [1e-2, 1e-1, 1.0, 1e1, 1e2];
    all.iter().zip(expected).for_each(|(own, other)| assert!((own / other - 1.0).abs() < 1e-12));
    assert_eq!(all.len(), 5);
}

/// Sway and yaw of a law whose mass matrix couples them: what is unmixed is what was mixed.
#[test]
fn coefficients_come_back_through_the_mixture() {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model("mariner").unwrap();
    let blocks = RegressionBlocks::new(&model, zoo.law("abkowitz").unwrap()).unwrap();
    let coupled = blocks.blocks.iter().find(|block| block.axes.len() == 2).unwrap();
    let mixed = mixed_source(coupled, &model);
    let is_mixed = coupled.mixing[(0, 1)] != 0.0 || coupled.mixing[(1, 0)] != 0.0;
    assert!(is_mixed, "{}", coupled.mixing);
    for i in 0..coupled.regressor_count() {
        let seen = DVector::from_iterator(2, mixed.iter().take(2).map(|target| target[i]));
        let own = &coupled.unmixing * seen;
        for axis in 0..2 {
            let value = model.coefficient(&coupled.names[axis][i]);
            assert!((own[axis] - value).abs() <= 1e-9 * (1.0 + value.abs()));
        }
    }
}
