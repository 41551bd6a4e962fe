#![allow(clippy::unwrap_used)]
use super::super::rows::RegressionTable;
use super::*;
use sistership_model::Zoo;
use sistership_model::coefficient::Axis;

/// One axis, its forces regressed on two terms.
fn blocks() -> (RegressionBlocks, Model) {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    model.coefficients.retain(|name, _| ["X_u", "X_vv"].contains(&name.as_str()));
    let mut blocks = RegressionBlocks::new(&model, zoo.law("abkowitz").unwrap()).unwrap();
    blocks.blocks.retain(|block| block.axes == [Axis::X]);
    (blocks, model)
}

/// Numbers of variance 1 that depend on their neighbours by `memory`.
fn noise(count: usize, memory: f64, seed: u32) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1_u32 << 24) - 0.5
    };
    let mut normal = || (0..12).map(|_| uniform()).sum::<f64>();
    let mut value = normal();
    (0..count)
        .map(|_| {
            value = memory * value + (1.0 - memory * memory).sqrt() * normal();
            value
        })
        .collect()
}

/// Coefficients 2 and -0.5 under noise, fitted nearly freely: estimates and standard errors.
fn fitted(seed: u32, memory: f64) -> [(f64, f64); 2] {
    let (blocks, model) = blocks();
    let (a, b) = (noise(600, 0.9, 3 * seed + 1), noise(600, 0.9, 3 * seed + 2));
    let disturbed = noise(600, memory, 3 * seed + 3);
    let y = (0..600).map(|k| 2.0 * a[k] - 0.5 * b[k] + 0.5 * disturbed[k]).collect();
    let tables: Vec<RegressionTable> = vec![vec![a, b, y]];
    let moments = vec![RegressionMoments::about_zero(&tables[0], 2, 1.0)];
    let parts = [SequenceTables { tables, dependent: 1 }];
    let choices = vec![vec![RidgeChoice { lambda: 1e-9, alpha: 0.0 }]];
    let errors = posterior_errors(
        &blocks,
        &moments,
        &sequence_rows(&blocks, &parts, false),
        &model,
        &choices,
    )
    .unwrap();
    let fit = super::super::ridge::fit_regressions(&blocks, &moments, &model, &choices)
        .with_errors(Some(errors));
    ["X_u", "X_vv"]
        .map(|name| (fit.coefficients[name].value, fit.coefficients[name].standard_error))
}

/// The root mean square of the errors by the standard errors that were given with them.
fn honesty(memory: f64) -> f64 {
    let one = |seed: u32| {
        let [(a, da), (b, db)] = fitted(seed, memory);
        ((a - 2.0) / da).powi(2) + ((b + 0.5) / db).powi(2)
    };
    ((0..200).map(one).sum::<f64>() / 400.0).sqrt()
}

#[test]
fn residuals_that_depend_on_each_other_widen_the_errors_as_much_as_they_should() {
    let (white, slow) = (honesty(0.0), honesty(0.9));
    assert!((0.9..1.1).contains(&white), "{white}");
    assert!((0.85..1.25).contains(&slow), "{slow}");
    assert!(fitted(1, 0.9)[0].1 > 2.0 * fitted(1, 0.0)[0].1);
}

/// A source that is held is as wrong as the trials say, however strongly it is held.
#[test]
fn a_strong_prior_does_not_make_a_wrong_source_sure() {
    let (blocks, mut model) = blocks();
    let (a, b) = (noise(600, 0.9, 1), noise(600, 0.9, 2));
    let y: Vec<f64> = a
        .iter()
        .zip(&b)
        .zip(noise(600, 0.0, 3))
        .map(|((a, b), e)| 2.0 * a - 0.5 * b + 0.1 * e)
        .collect();
    let tables: Vec<RegressionTable> = vec![vec![a, b, y]];
    let moments = vec![RegressionMoments::about_zero(&tables[0], 2, 1.0)];
    let parts = [SequenceTables { tables, dependent: 1 }];
    let mut error = |source: f64| {
        model.coefficients.get_mut("X_u").unwrap().value = source;
        model.coefficients.get_mut("X_vv").unwrap().value = -0.5;
        let choices = vec![vec![RidgeChoice { lambda: 1e6, alpha: 0.0 }]];
        let errors = posterior_errors(
            &blocks,
            &moments,
            &sequence_rows(&blocks, &parts, false),
            &model,
            &choices,
        )
        .unwrap();
        errors.covariance[(0, 0)].sqrt()
    };
    let (wrong, right) = (error(1.0), error(2.0));
    assert!(wrong > 0.4, "half of it is missing: {wrong}");
    assert!(right < 0.5 * wrong, "nothing is missing: {right}");
}

#[test]
fn a_posterior_keeps_the_covariance() {
    let covariance = DMatrix::from_row_slice(2, 2, &[0.04, -0.006, -0.006, 0.01]);
    let names = vec!["X_u".to_owned(), "X_vv".to_owned()];
    let none = DMatrix::zeros(2, 2);
    let errors = CoefficientErrors {
        names,
        covariance: covariance.clone(),
        source: none.clone(),
        cross: none,
    };
    let (_, model) = blocks();
    let root = errors.to_posterior(&model).unwrap().covariance_root().unwrap();
    let root = DMatrix::from_fn(2, 2, |i, j| root[i].get(j).copied().unwrap_or(0.0));
    assert!((&root * root.transpose() - covariance).amax() < 1e-6);
    assert!(model.posterior.is_none());
}
