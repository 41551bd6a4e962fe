//! Comparisons against what was worked by hand.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use sistership_model::trial::Channel;
use sistership_model::{Trial, Zoo};

use super::*;

/// A ship that runs straight at its approach speed, as every law with X of zero there does: what a
/// log says too much is the error.
fn straight(speed_m_s: f64, too_much: [f64; 4]) -> Trial {
    let t_s: Vec<f64> = (0..4).map(f64::from).collect();
    let zeros = || vec![0.0; 4];
    let channels = [
        (Channel::U, too_much.map(|error| speed_m_s + error).to_vec()),
        (Channel::V, zeros()),
        (Channel::R, zeros()),
        (Channel::Psi, zeros()),
        (Channel::Delta, zeros()),
    ];
    Trial { t_s, channels: BTreeMap::from(channels), ..Trial::default() }
}

#[test]
fn errors_are_those_worked_by_hand() {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    // Straight running only: without coefficients the hull has neither drag nor asymmetry.
    model.coefficients.retain(|name, _| name == "Y_v" || name == "N_r");
    let law = zoo.law(&model.law).unwrap();
    let speed = model.speed_m_s.unwrap();
    let trial = straight(speed, [0.0, 0.3, -0.1, 0.2]);
    let names = ["a", "b"].map(|name| ComparisonModel { name, model: &model, law });
    let comparison = compare(&names, &[("run", &trial)]).unwrap();
    // Errors 0, -0.3, 0.1, -0.2: their squares are 0.14, by four 0.035. The log's mean is 0.1 above
    // the speed, its variance (0.01 + 0.04 + 0.04 + 0.01)/4 = 0.025: 0.035/0.025 = 1.4.
    let error = &comparison.trials[0].errors[1];
    assert!((error.rmse["u"] - 0.035_f64.sqrt()).abs() < 1e-12, "{error:?}");
    assert!((error.standardised_mse.unwrap() - 1.4).abs() < 1e-9, "{error:?}");
    assert!((comparison.models[0].standardised_mse.unwrap() - 1.4).abs() < 1e-9);
    assert_eq!((comparison.trials[0].samples, comparison.trials[0].duration_s), (4, 3.0));
}

#[test]
fn errors_over_all_trials_count_by_samples() {
    let error = |mse: Option<f64>| TrialError {
        rmse: BTreeMap::new(),
        standardised_mse: mse,
        reason: None,
    };
    let trial = |samples: usize, mse: Option<f64>| ComparedTrial {
        trial: String::new(),
        samples,
        duration_s: 1.0,
        errors: vec![error(mse)],
    };
    // (10*3 + 30*1)/40
    let all = [trial(10, Some(3.0)), trial(30, Some(1.0))];
    assert_eq!(trials::mean_over_trials(&all, 0), Some(1.5));
    assert_eq!(trials::mean_over_trials(&[trial(10, Some(3.0)), trial(30, None)], 0), None);
    assert_eq!(trials::mean_over_trials(&[], 0), None);
}

#[test]
fn coefficients_and_figures_stand_side_by_side() {
    let zoo = Zoo::load_embedded().unwrap();
    let models = ["mariner", "kvlcc2"].map(|name| (name, zoo.find_model(name).unwrap()));
    let compared = models.each_ref().map(|(name, model)| ComparisonModel {
        name,
        model,
        law: zoo.law(&model.law).unwrap(),
    });
    let comparison = compare(&compared, &[]).unwrap();
    let coefficient = |name: &str| {
        let row = comparison.coefficients.iter().find(|row| row.name == name).unwrap();
        row.values.clone()
    };
    let own = models[0].1.coefficient("X_udeltadelta");
    let found = coefficient("X_udeltadelta");
    assert_eq!((found[0].unwrap().value, found[1]), (own, None));
    let advance = comparison.figures.iter().find(|row| row.name == "IMO: advance").unwrap();
    assert_eq!(advance.unit, "L");
    assert!(advance.values.iter().all(|value| value.unwrap().pass == Some(true)), "{advance:?}");
    assert!(comparison.models.iter().all(|model| model.standardised_mse.is_none()));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let said = |names: &[&str]| check_names(names).unwrap_err().to_string();
    assert!(said(&["a"]).contains("two to five") && said(&["a"; 6]).contains("not 6"));
    assert!(said(&["a", "b", "a"]).contains("`a` is listed twice"));
    assert!(check_names(&["a", "b"]).is_ok());
}
