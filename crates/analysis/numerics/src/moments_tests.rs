#![allow(clippy::unwrap_used)]
use super::*;

#[test]
fn merging_parts_gives_the_whole() {
    let column = |f: &dyn Fn(f64) -> f64| (0..1000).map(|k| f(f64::from(k))).collect::<Vec<f64>>();
    let columns = vec![
        column(&|k| 1e4 + (0.1 * k).sin()),
        column(&|k| k * 0.01),
        column(&|k| (0.3 * k).cos()),
    ];
    let whole = RegressionMoments::from_columns(&columns, 2);
    let part = |range: std::ops::Range<usize>| {
        let columns: Vec<Vec<f64>> =
            columns.iter().map(|column| column[range.clone()].to_vec()).collect();
        RegressionMoments::from_columns(&columns, 2)
    };
    let mut merged = part(0..137);
    merged.merge_samples(&part(137..1000));
    for (i, j) in [(0, 0), (0, 1), (1, 1)] {
        assert!(
            (whole.regressor_covariance(i, j) - merged.regressor_covariance(i, j)).abs() < 1e-10
        );
    }
    assert!((whole.regressor_variance(0) - 0.5).abs() < 0.01, "no cancellation at a mean of 1e4");
}

fn parts() -> Vec<RegressionMoments> {
    let part = |phase: f64| {
        let column =
            |f: &dyn Fn(f64) -> f64| (0..50).map(|k| f(f64::from(k) + phase)).collect::<Vec<f64>>();
        RegressionMoments::from_columns(
            &[
                column(&|k| (0.3 * k).sin()),
                column(&|k| 2.0 + (0.1 * k).cos()),
                column(&|k| 0.01 * k),
            ],
            2,
        )
    };
    [0.0, 11.0, 37.0].map(part).to_vec()
}

fn near(a: &RegressionMoments, b: &RegressionMoments) -> bool {
    a.to_numbers().iter().zip(b.to_numbers()).all(|(a, b)| (a - b).abs() < 1e-9 * (1.0 + b.abs()))
}

#[test]
fn leaving_one_out_gives_the_others() {
    let parts = parts();
    let (without, all) = RegressionMoments::leave_one_out(&parts).expect("three parts");
    assert!(near(&all, &RegressionMoments::merge_all(&parts).expect("three parts")));
    assert!(near(
        &without[1],
        &RegressionMoments::merge_all([&parts[0], &parts[2]]).expect("two parts")
    ));
    assert!(near(&without[0], &RegressionMoments::merge_all(&parts[1..]).expect("two parts")));
}

#[test]
fn mapping_statistics_is_mapping_samples() {
    let (x, z, y) = (vec![1.0, 2.0, 4.0, 7.0], vec![0.5, -1.0, 2.0, 0.0], vec![3.0, 1.0, 0.0, 2.0]);
    let less = |k: usize| y[k] - 0.3 * x[k] + 2.0 * z[k];
    let direct = RegressionMoments::from_columns(
        &[x.iter().map(|x| 5.0 * x).collect(), z.clone(), (0..4).map(less).collect()],
        2,
    );
    let map = DMatrix::from_row_slice(3, 3, &[5.0, 0.0, -0.3, 0.0, 1.0, 2.0, 0.0, 0.0, 1.0]);
    assert!(near(&RegressionMoments::from_columns(&[x, z, y], 2).map_linear(&map, 2), &direct));
}

#[test]
fn about_the_origin_are_the_products_themselves() {
    let columns = vec![vec![1.0, 2.0, 4.0], vec![3.0, 1.0, 0.0]];
    assert!(near(
        &RegressionMoments::from_columns(&columns, 1).about_origin(),
        &RegressionMoments::about_zero(&columns, 1, 1.0)
    ));
}

#[test]
fn numbers_come_back() {
    let one = &parts()[0];
    let numbers = one.to_numbers();
    assert_eq!(RegressionMoments::from_numbers(&numbers, 2, 1).as_ref(), Some(one));
    assert_eq!(RegressionMoments::from_numbers(&numbers[1..], 2, 1), None);
    assert_eq!(RegressionMoments::from_numbers(&numbers, 3, 1), None);
}

/// Three regressors and two targets over 40 samples from a time on, none of them centred.
fn columns(from: usize) -> Vec<Vec<f64>> {
    let column = |f: &dyn Fn(f64) -> f64| (from..from + 40).map(|k| f(k as f64)).collect();
    vec![
        column(&|k| 1.0 + (0.3 * k).sin()),
        column(&|k| 0.02 * k - 3.0),
        column(&|k| (0.11 * k).cos()),
        column(&|k| 5.0 + (0.2 * k).sin()),
        column(&|k| 0.1 * k * (0.4 * k).cos() - 2.0),
    ]
}

fn mean(column: &[f64]) -> f64 {
    column.iter().sum::<f64>() / column.len() as f64
}

fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let (of_a, of_b) = (mean(a), mean(b));
    a.iter().zip(b).map(|(a, b)| (a - of_a) * (b - of_b)).sum::<f64>() / a.len() as f64
}

/// Each statistic against its definition, sample by sample.
#[test]
fn statistics_are_those_of_the_samples() {
    let columns = columns(0);
    let moments = RegressionMoments::from_columns(&columns, 3);
    let near = |own: f64, direct: f64| assert!((own - direct).abs() < 1e-12, "{own} {direct}");
    assert_eq!((moments.regressors(), moments.targets(), moments.count), (3, 2, 40.0));
    for i in 0..3 {
        near(moments.regressor_mean(i), mean(&columns[i]));
        near(moments.regressor_variance(i), covariance(&columns[i], &columns[i]));
        for j in 0..3 {
            near(moments.regressor_covariance(i, j), covariance(&columns[i], &columns[j]));
        }
        for target in 0..2 {
            let direct = covariance(&columns[i], &columns[3 + target]);
            near(moments.covariance_with_target(i, target), direct);
        }
    }
    for target in 0..2 {
        let own = &columns[3 + target];
        near(moments.target_variance(target), covariance(own, own));
    }
    let (own, cross) = moments.covariance_blocks();
    near(own[(0, 2)], covariance(&columns[0], &columns[2]));
    near(cross[(1, 1)], covariance(&columns[1], &columns[4]));
    let product = |i: usize, j: usize| {
        columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum::<f64>() / 40.0
    };
    near(moments.raw_products()[(1, 4)], product(1, 4));
}

/// The sum of centred regressors times centred residuals, with the means of a larger set.
#[test]
fn a_score_is_that_of_the_samples_about_the_means_of_all() {
    let (own, rest) = (columns(0), columns(70));
    let mut all = RegressionMoments::from_columns(&own, 3);
    all.merge_samples(&RegressionMoments::from_columns(&rest, 3));
    let coefficients = DVector::from_vec(vec![0.7, -1.3, 0.4]);
    let score = RegressionMoments::from_columns(&own, 3).residual_score(&all, &coefficients);
    let both = |i: usize| mean(&[own[i].as_slice(), rest[i].as_slice()].concat());
    let means: Vec<f64> = (0..5).map(both).collect();
    for i in 0..3 {
        let of = |k: usize| {
            let explained: f64 = (0..3).map(|j| coefficients[j] * (own[j][k] - means[j])).sum();
            (own[i][k] - means[i]) * (own[3][k] - means[3] - explained)
        };
        let direct: f64 = (0..40).map(of).sum();
        assert!((score[i] - direct).abs() < 1e-10, "{i}: {} {direct}", score[i]);
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let mut numbers = parts()[0].to_numbers();
    numbers[2] = f64::NAN;
    assert_eq!(RegressionMoments::from_numbers(&numbers, 2, 1), None);
}

#[test]
fn trials_are_merged_by_regression_where_they_are_kept() {
    let parts = parts();
    let by_trial: Vec<Vec<RegressionMoments>> = vec![
        vec![parts[0].clone(), parts[1].clone()],
        vec![parts[1].clone(), parts[2].clone()],
        vec![parts[2].clone(), parts[0].clone()],
    ];
    let both = merge_trials(&by_trial, |trial| trial != 1).unwrap();
    assert_eq!(both.len(), 2);
    assert!(near(&both[0], &RegressionMoments::merge_all([&parts[0], &parts[2]]).unwrap()));
    assert!(near(&both[1], &RegressionMoments::merge_all([&parts[1], &parts[0]]).unwrap()));
    assert!(merge_trials(&by_trial, |_| false).is_none());
}

/// The weight of a sample counts in sums, and not in means.
#[test]
fn a_weight_makes_samples_count_less() {
    let columns = columns(0);
    let (whole, half) = (
        RegressionMoments::about_zero(&columns, 3, 1.0),
        RegressionMoments::about_zero(&columns, 3, 0.5),
    );
    assert_eq!((whole.count, half.count), (40.0, 20.0));
    assert!((whole.regressor_covariance(0, 1) - half.regressor_covariance(0, 1)).abs() < 1e-12);
    assert!((whole.regressor_covariance(0, 2) - whole.raw_products()[(0, 2)]).abs() < 1e-12);
}

#[test]
fn both_triangles_of_symmetric_products_are_the_same() {
    let mut moments = RegressionMoments::from_columns(&columns(0), 3);
    moments.products[(2, 0)] += 1e-3;
    let kept = moments.products[(0, 2)];
    let symmetric = moments.symmetrize_products();
    assert_eq!((symmetric.products[(0, 2)], symmetric.products[(2, 0)]), (kept, kept));
}
