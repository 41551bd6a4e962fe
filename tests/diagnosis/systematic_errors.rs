//! An instrument that erred when the model was fitted errs later, too: that is not new, and what is
//! new is found beside it.

use sistership_diagnosis::{Diagnosis, Settings};
use sistership_model::Trial;
use sistership_model::effect::AppliedEffect;

use sistership_tests::hidden_effects::baseline::{self, Baseline, fitted, programme};
use sistership_tests::hidden_effects::cases;
use sistership_tests::hidden_effects::truth::{Hidden, effect, trials};

/// Of a gyro whose compass is right.
const BIAS_RAD_S: f64 = 1e-3;

fn biased(more: &[AppliedEffect]) -> Hidden {
    let biased = effect("yaw-rate-bias", "constant", &[("bias_rad_s", BIAS_RAD_S)]);
    Hidden {
        effects: std::iter::once(biased).chain(more.iter().cloned()).collect(),
        ..Hidden::default()
    }
}

fn diagnosed(baseline: &Baseline, hidden: &Hidden) -> Diagnosis {
    let trials: Vec<Trial> = trials(hidden, &cases::programme(), 77);
    baseline::diagnosed(baseline, &trials, &Settings::default())
}

#[test]
fn what_instruments_always_did_is_not_named() {
    let clean: Vec<Trial> = trials(&biased(&[]), &programme(), 7);
    let baseline = fitted("mariner", "sr108", &clean.iter().collect::<Vec<_>>());
    let systematic_errors = &baseline.model.uncertainty.as_ref().unwrap().systematic_errors;
    println!("{:?}", systematic_errors[0].parameters);
    assert_eq!(
        systematic_errors.iter().map(|error| error.name.as_str()).collect::<Vec<_>>(),
        ["yaw-rate-bias"]
    );
    // Coefficients have taken a part of it.
    assert!(
        (0.5..1.1).contains(&(systematic_errors[0].parameters["bias_rad_s"].value / BIAS_RAD_S))
    );
    assert_eq!(diagnosed(&baseline, &biased(&[])).effects, []);
    let current = effect("current", "constant", &[("north_m_s", 0.3), ("east_m_s", 0.3)]);
    let named: Vec<String> = diagnosed(&baseline, &biased(&[current]))
        .effects
        .into_iter()
        .map(|found| found.name)
        .collect();
    assert_eq!(named.first().map(String::as_str), Some("current"));
    assert!(!named.contains(&"yaw-rate-bias".to_owned()), "{named:?}");
}
