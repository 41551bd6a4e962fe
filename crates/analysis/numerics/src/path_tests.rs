#![allow(clippy::unwrap_used)]
use super::*;

fn samples() -> Vec<Vec<f64>> {
    let x: Vec<f64> = (0..400).map(|k| (0.11 * f64::from(k)).sin()).collect();
    let z: Vec<f64> = (0..400).map(|k| 3.0 + (0.07 * f64::from(k)).cos()).collect();
    let y = x.iter().zip(&z).map(|(x, z)| 2.0 * x - 0.5 * z).collect();
    vec![x, z, y]
}

#[test]
fn known_coefficients_are_recovered_and_the_source_holds_when_told_to() {
    let path = RidgePath::new(&RegressionMoments::from_columns(&samples(), 2), &[vec![1.0, 1.0]]);
    let at =
        |lambda: f64, alpha: f64| path.solve_target(0, RidgeChoice { lambda, alpha }, &[1.0, 1.0]);
    let free = at(1e-12, 0.0);
    assert!((free[0] - 2.0).abs() < 1e-9 && (free[1] + 0.5).abs() < 1e-9);
    let held = at(1e9, 0.0);
    assert!((held[0] - 1.0).abs() < 1e-6 && (held[1] - 1.0).abs() < 1e-6);
    assert!(at(1e9, 1.0)[0].abs() < 1e-6);
}

#[test]
fn the_closed_form_solves_the_normal_equations() {
    let moments = RegressionMoments::from_columns(&samples(), 2);
    let (lambda, alpha, source) = (0.3, 0.2, [1.5, -1.0]);
    let beta = RidgePath::new(&moments, &[source.to_vec()]).solve_target(
        0,
        RidgeChoice { lambda, alpha },
        &source,
    );
    for i in 0..2 {
        let sigma = moments.regressor_variance(i).sqrt();
        let left: f64 = (0..2).map(|j| moments.regressor_covariance(i, j) * beta[j]).sum::<f64>()
            / sigma
            + lambda * beta[i] * sigma;
        let right = moments.covariance_with_target(i, 0) / sigma
            + lambda * (1.0 - alpha) * source[i] * sigma;
        assert!((left - right).abs() < 1e-12);
    }
}

#[test]
fn shrinkage_makes_a_prior_more_precise() {
    let moments = RegressionMoments::from_columns(&samples(), 2);
    let (lambda, source, shrinkage) = (0.3, [1.5, -1.0], [1.0, 9.0]);
    let path = RidgePath::with_shrinkage(&moments, &[source.to_vec()], &shrinkage);
    let beta = path.solve_target(0, RidgeChoice { lambda, alpha: 0.0 }, &source);
    for i in 0..2 {
        let precision = lambda * shrinkage[i] * moments.regressor_variance(i);
        let left: f64 = (0..2).map(|j| moments.regressor_covariance(i, j) * beta[j]).sum::<f64>()
            + precision * beta[i];
        assert!(
            (left - moments.covariance_with_target(i, 0) - precision * source[i]).abs() < 1e-12
        );
    }
    let ratio = |deviations: Vec<(f64, f64)>| deviations[1].1;
    let plain = RidgePath::new(&moments, &[source.to_vec()]);
    assert!(
        (ratio(plain.coefficient_deviations(lambda)) / ratio(path.coefficient_deviations(lambda))
            - 3.0)
            .abs()
            < 1e-12
    );
}

/// Against the density of the samples themselves, a normal distribution of as many dimensions
/// as there are samples.
#[test]
fn the_misfit_is_that_of_the_marginal_likelihood() {
    let mut columns: Vec<Vec<f64>> = samples().iter().map(|column| column[..40].to_vec()).collect();
    columns[2].iter_mut().enumerate().for_each(|(k, y)| *y += 0.3 * (5.1 * k as f64).sin());
    let source = [1.5, -1.0];
    let path = RidgePath::new(&RegressionMoments::from_columns(&columns, 2), &[source.to_vec()]);
    let centred = columns.iter().map(|column| {
        let column = DVector::from_vec(column.clone());
        let mean = column.mean();
        column.add_scalar(-mean)
    });
    let centred: Vec<DVector<f64>> = centred.collect();
    let unexplained = &centred[2] - &centred[0] * source[0] - &centred[1] * source[1];
    let direct = |lambda: f64| {
        let spread = |x: &DVector<f64>| x * x.transpose() / (x.norm_squared() * lambda);
        let covariance = DMatrix::identity(40, 40) + spread(&centred[0]) + spread(&centred[1]);
        let variance =
            unexplained.dot(&covariance.clone().lu().solve(&unexplained).unwrap()) / 40.0;
        variance.ln() + covariance.determinant().ln() / 40.0
    };
    for lambda in [1e-4, 1e-2, 1.0] {
        assert!((path.evidence_misfit(0, lambda) - direct(lambda)).abs() < 1e-9, "{lambda}");
    }
}

/// Against the residuals themselves, sample by sample.
#[test]
fn the_error_by_alpha_is_that_of_the_samples() {
    let moments = RegressionMoments::from_columns(&samples(), 2);
    let source = [2.5, -0.7];
    let path = RidgePath::new(&moments, &[source.to_vec()]);
    let held_out: Vec<Vec<f64>> = samples().iter().map(|column| column[..150].to_vec()).collect();
    let validation = ValidationSamples::new(&RegressionMoments::from_columns(&held_out, 2));
    let error = path.error_by_alpha(0, 1.0, &source, &validation);
    for alpha in [0.0, 0.3, 1.0] {
        let beta = path.solve_target(0, RidgeChoice { lambda: 1.0, alpha }, &source);
        let residual =
            |k: usize| held_out[2][k] - beta[0] * held_out[0][k] - beta[1] * held_out[1][k];
        let direct = (0..150).map(|k| residual(k).powi(2)).sum::<f64>() / 150.0;
        assert!((error.error_at(alpha) - direct).abs() < 1e-12, "{alpha}");
    }
}

/// Two regressors of some correlation, one that does not vary, and two targets with noise.
fn two_targets() -> Vec<Vec<f64>> {
    let column = |f: &dyn Fn(f64) -> f64| (0..60).map(|k| f(f64::from(k))).collect::<Vec<f64>>();
    let x = column(&|k| (0.31 * k).sin());
    let z: Vec<f64> =
        x.iter().zip(column(&|k| 2.0 + (0.17 * k).cos())).map(|(x, w)| 0.4 * x + 3.0 * w).collect();
    let with = |a: f64, b: f64, phase: f64| {
        let noise = column(&|k| 0.3 * (5.1 * k + phase).sin());
        (0..60).map(|k| a * x[k] + b * z[k] + noise[k]).collect()
    };
    vec![x.clone(), z.clone(), vec![4.0; 60], with(2.0, -0.5, 0.0), with(-1.0, 0.2, 2.0)]
}

const SOURCES: [[f64; 3]; 2] = [[1.5, -1.0, 7.0], [-0.4, 0.6, -3.0]];

fn two_target_path() -> (RidgePath, RegressionMoments) {
    let moments = RegressionMoments::from_columns(&two_targets(), 3);
    let sources: Vec<Vec<f64>> = SOURCES.iter().map(|source| source.to_vec()).collect();
    (RidgePath::new(&moments, &sources), moments)
}

/// `C + lambda I` of the two that vary, and their deviations.
fn standardised(moments: &RegressionMoments, lambda: f64) -> (DMatrix<f64>, [f64; 2]) {
    let sigma = [0, 1].map(|i| moments.regressor_variance(i).sqrt());
    let entry = |i: usize, j: usize| {
        moments.regressor_covariance(i, j) / (sigma[i] * sigma[j])
            + if i == j { lambda } else { 0.0 }
    };
    (DMatrix::from_fn(2, 2, entry), sigma)
}

#[test]
fn a_regressor_that_does_not_vary_keeps_its_source() {
    let (path, _) = two_target_path();
    for (target, source) in SOURCES.iter().enumerate() {
        for (lambda, alpha) in [(0.2, 0.0), (3.0, 0.4)] {
            let solved = path.solve_target(target, RidgeChoice { lambda, alpha }, source);
            assert_eq!(solved[2], source[2]);
        }
    }
}

/// Against the residuals themselves, with the trace of the hat matrix as degrees of freedom.
#[test]
fn the_residual_variance_is_that_of_the_samples() {
    let (path, moments) = two_target_path();
    let columns = two_targets();
    let (lambda, alpha) = (0.3, 0.25);
    let (sum, _) = standardised(&moments, lambda);
    let freedom = (standardised(&moments, 0.0).0 * sum.try_inverse().unwrap()).trace();
    for target in 0..2 {
        let choice = RidgeChoice { lambda, alpha };
        let beta = path.solve_target(target, choice, &SOURCES[target]);
        let y = &columns[3 + target];
        let left: Vec<f64> =
            (0..60).map(|k| y[k] - beta[0] * columns[0][k] - beta[1] * columns[1][k]).collect();
        let mean = left.iter().sum::<f64>() / 60.0;
        let squares: f64 = left.iter().map(|left| (left - mean).powi(2)).sum();
        let direct = squares / (60.0 - freedom - 1.0);
        let own = path.residual_variance(target, choice);
        assert!((own - direct).abs() < 1e-12, "{target}: {own} {direct}");
        assert_eq!(path.target_variance(target), moments.target_variance(target));
    }
}

/// Few samples leave one degree of freedom at least.
#[test]
fn a_residual_variance_is_finite_with_as_few_samples_as_regressors() {
    let columns: Vec<Vec<f64>> = two_targets().iter().map(|column| column[..3].to_vec()).collect();
    let moments = RegressionMoments::from_columns(&columns, 3);
    let path = RidgePath::new(&moments, &[SOURCES[0].to_vec(), SOURCES[1].to_vec()]);
    let choice = RidgeChoice { lambda: 1e-3, alpha: 0.0 };
    let beta = path.solve_target(0, choice, &SOURCES[0]);
    let left: Vec<f64> =
        (0..3).map(|k| columns[3][k] - beta[0] * columns[0][k] - beta[1] * columns[1][k]).collect();
    let mean = left.iter().sum::<f64>() / 3.0;
    let squares: f64 = left.iter().map(|left| (left - mean).powi(2)).sum();
    assert!((path.residual_variance(0, choice) - squares).abs() < 1e-12);
}

/// `(n D (C + lambda I) D)^-1` at residual variance 1, and `1/(n lambda sigma^2)` of the prior.
#[test]
fn deviations_are_those_of_the_normal_equations() {
    let (path, moments) = two_target_path();
    for lambda in [0.05, 2.0] {
        let (sum, sigma) = standardised(&moments, lambda);
        let inverse = sum.try_inverse().unwrap();
        let all = path.coefficient_deviations(lambda);
        for i in 0..2 {
            let posterior = (inverse[(i, i)] / 60.0).sqrt() / sigma[i];
            let prior = 1.0 / (60.0 * lambda).sqrt() / sigma[i];
            assert!((all[i].0 - posterior).abs() < 1e-12 * posterior, "{lambda}, {i}");
            assert!((all[i].1 - prior).abs() < 1e-12 * prior, "{lambda}, {i}");
        }
        assert_eq!(all[2], (0.0, 0.0));
    }
}

/// `n (Cov + lambda diag(Var))` of those that vary.
#[test]
fn the_curvature_is_that_of_the_sum_of_squares_and_the_pull() {
    let (path, moments) = two_target_path();
    let (lambda, own) = (0.7, path.cost_curvature(0.7));
    for i in 0..3 {
        for j in 0..3 {
            let direct = match (i == 2 || j == 2, i == j) {
                (true, same) => f64::from(u8::from(same)),
                (false, true) => 60.0 * moments.regressor_variance(i) * (1.0 + lambda),
                (false, false) => 60.0 * moments.regressor_covariance(i, j),
            };
            let near = (own[(i, j)] - direct).abs() < 1e-10 * (1.0 + direct.abs());
            assert!(near, "{i}, {j}: {} {direct}", own[(i, j)]);
        }
    }
}

/// Of two regressors of correlation `r` it is `(1 + r)/(1 - r)`, whatever does not vary beside
/// them.
#[test]
fn the_condition_number_is_that_of_what_varies() {
    let (path, moments) = two_target_path();
    let (_, sigma) = standardised(&moments, 0.0);
    let r = (moments.regressor_covariance(0, 1) / (sigma[0] * sigma[1])).abs();
    let closed = (1.0 + r) / (1.0 - r);
    assert!((path.condition_number() / closed - 1.0).abs() < 1e-9, "{closed}");
    let columns =
        vec![two_targets()[0].clone(), two_targets()[0].clone(), two_targets()[3].clone()];
    let same = RidgePath::new(&RegressionMoments::from_columns(&columns, 2), &[vec![0.0; 2]]);
    assert!(same.condition_number() > 1e14 && same.condition_number() <= 1.0 / f64::EPSILON);
}

#[test]
fn regressors_that_cannot_be_told_apart_form_a_group() {
    let [x, z, _, y, _] = <[Vec<f64>; 5]>::try_from(two_targets()).unwrap();
    let near = |size: f64| -> Vec<f64> {
        (0..60).map(|k| 2.0 * x[k] + size * (3.7 * k as f64).cos()).collect()
    };
    let groups = |third: Vec<f64>| {
        let columns = vec![x.clone(), z.clone(), third, y.clone()];
        let moments = RegressionMoments::from_columns(&columns, 3);
        RidgePath::new(&moments, &[vec![0.0; 3]]).collinear_groups(1e-6)
    };
    assert_eq!(groups(near(1e-5)), [vec![0, 2]]);
    assert_eq!(groups(near(0.5)), Vec::<Vec<usize>>::new());
}

/// A regressor that does not vary has an eigenvalue of zero, and is no group.
#[test]
fn a_regressor_alone_is_no_group() {
    assert!(two_target_path().0.collinear_groups(1e-6).is_empty());
}
