#![allow(clippy::unwrap_used)]
use std::collections::BTreeMap;

use super::*;
use crate::statistics::{RegressionFrame, TrialStatistics};
use sistership_identification::refine::{CoefficientFit, RidgeChoices, fit_regressions};
use sistership_identification::testing::{
    mariner_model, simulated_trials, with_scaled_coefficients,
};
use sistership_model::{Law, Model};
use sistership_numerics::{RegressionMoments, RidgeChoice};

fn statistics(frame_of: &Model, law: &Law, truth: &Model, noise: f64) -> Vec<TrialStatistics> {
    let frame = RegressionFrame::new(frame_of, law, "law", None).unwrap();
    simulated_trials(truth, law, noise)
        .iter()
        .map(|trial| TrialStatistics::from_trial(&frame, trial).unwrap())
        .collect()
}

fn values(model: &Model) -> BTreeMap<String, f64> {
    model.coefficients.iter().map(|(name, quantity)| (name.clone(), quantity.value)).collect()
}

/// The published estimator on the samples' own statistics, at one lambda for every acceleration.
fn published(model: &Model, law: &Law, trials: &[TrialStatistics], lambda: f64) -> CoefficientFit {
    let blocks = sistership_identification::refine::RegressionBlocks::new(model, law).unwrap();
    let of = |block: usize| {
        RegressionMoments::merge_all(trials.iter().map(|trial| &trial.regressions[block].moments))
            .unwrap()
    };
    let moments: Vec<RegressionMoments> = (0..blocks.blocks.len()).map(of).collect();
    let choices: RidgeChoices = blocks
        .blocks
        .iter()
        .map(|b| vec![RidgeChoice { lambda, alpha: 0.0 }; b.axes.len()])
        .collect();
    fit_regressions(&blocks, &moments, model, &choices)
}

#[test]
fn from_statistics_it_is_the_published_estimator() {
    let (model, law) = mariner_model();
    let trials = statistics(
        &model,
        &law,
        &with_scaled_coefficients(&model, |name| if name.contains('r') { 1.2 } else { 0.9 }),
        1e-3,
    );
    for lambda in [1e-4, 0.1] {
        let settings = BulkSettings {
            lambda_count: 2,
            lambda_min: lambda,
            lambda_max: 1.0001 * lambda,
            ..Default::default()
        };
        let solved = solve_path(&trials, BulkPrior::Source(&values(&model)), &settings)
            .unwrap()
            .coefficients_at(0)
            .0;
        for (name, direct) in published(&model, &law, &trials, lambda).coefficients {
            let (bulk, unit) = (solved[&name], direct.prior_deviation);
            assert!(
                (bulk.value - direct.value).abs() < 1e-3 * unit,
                "{name}: {} {}",
                bulk.value,
                direct.value
            );
            assert!(
                (bulk.standard_error / direct.standard_error - 1.0).abs() < 0.35,
                "{name}: {bulk:?} {direct:?}"
            );
        }
    }
}

#[test]
fn a_ship_that_differs_from_its_model_is_found_and_sails() {
    let (model, law) = mariner_model();
    let truth =
        with_scaled_coefficients(
            &model,
            |name| if name == "N_r" || name == "Y_v" { 1.25 } else { 1.0 },
        );
    let trials = statistics(&model, &law, &truth, 1e-4);
    let source = values(&model);
    let request = BulkRequest {
        model: &model,
        law: &law,
        trials: &trials,
        prior: BulkPrior::Source(&source),
        settings: &BulkSettings::default(),
    };
    let refined = refine_ship(&request).unwrap();
    assert!(refined.worst_change() < 0.0, "{:?}", refined.axes);
    let of = |name: &str| refined.coefficients.iter().find(|c| c.name == name).unwrap().clone();
    let moved = of("N_r");
    let (before, after) = (
        (moved.before - truth.coefficient("N_r")).abs(),
        (moved.refined - truth.coefficient("N_r")).abs(),
    );
    assert!(after < 0.6 * before, "{moved:?}");
    assert!(refined.after.failures.is_empty() && refined.after.tactical_diameter_l.is_some());
}

#[test]
fn a_model_that_no_longer_sails_is_pulled_back() {
    let (model, law) = mariner_model();
    let nonsense =
        with_scaled_coefficients(
            &model,
            |name| if name == "N_r" || name == "N_v" { -2.0 } else { 1.0 },
        );
    let frame = RegressionFrame::new(&model, &law, "law", None).unwrap();
    // What the Mariner sailed, but with rates of turn that answer as an unstable ship's would.
    let mut trials: Vec<TrialStatistics> = simulated_trials(&model, &law, 1e-3)
        .iter()
        .map(|trial| TrialStatistics::from_trial(&frame, trial).unwrap())
        .collect();
    for trial in &mut trials {
        let regression = &mut trial.regressions[1];
        let mut map = nalgebra::DMatrix::identity(32, 32);
        let last = regression.moments.regressors() + 1;
        map = map.resize(last + 1, last + 1, 0.0);
        (0..=last).for_each(|k| map[(k, k)] = 1.0);
        for (k, name) in regression.names[1].clone().iter().enumerate() {
            let wrong = nonsense.coefficient(name) - model.coefficient(name);
            (0..2).for_each(|target| {
                map[(k, last - 1 + target)] = regression.mixing[target][1] * wrong
            });
        }
        regression.moments = regression.moments.map_linear(&map, last - 1);
    }
    let source = values(&model);
    let request = BulkRequest {
        model: &model,
        law: &law,
        trials: &trials,
        prior: BulkPrior::Source(&source),
        settings: &BulkSettings::default(),
    };
    let solved = solve_path(&trials, request.prior, request.settings).unwrap();
    let loose =
        simulate_check(&[&refined_model(&model, &solved.coefficients_at(0).0, "test")], &law)
            .remove(0);
    assert!(!loose.failures.is_empty(), "the case is one that diverges: {loose:?}");
    let refined = refine_ship(&request).unwrap();
    assert!(refined.pulled > 0 && refined.after.failures.is_empty(), "{refined:?}");
}

#[test]
fn what_cannot_be_refined_says_why() {
    let (model, law) = mariner_model();
    let source = values(&model);
    let refused = |trials: &[TrialStatistics], prior: BulkPrior<'_>, settings: &BulkSettings| {
        solve_path(trials, prior, settings).err().unwrap().to_string()
    };
    let settings = BulkSettings::default();
    assert!(refused(&[], BulkPrior::Source(&source), &settings).contains("no trial"));
    let trials = statistics(&model, &law, &model, 0.0);
    assert!(
        refused(&trials, BulkPrior::Family { axes: &[], design_effect: 1.0 }, &settings)
            .contains("X_0")
            || refused(&trials, BulkPrior::Family { axes: &[], design_effect: 1.0 }, &settings)
                .contains("X_u")
    );
    let wrong = BulkSettings { lambda_min: 0.0, ..settings };
    assert!(refused(&trials, BulkPrior::Source(&source), &wrong).contains("settings.lambda_min"));
    let mut fewer = model.clone();
    fewer.coefficients.remove("N_uu");
    let mixed = [trials[..1].to_vec(), statistics(&fewer, &law, &model, 0.0)].concat();
    assert!(refused(&mixed, BulkPrior::Source(&source), &settings).contains("different models"));
}
