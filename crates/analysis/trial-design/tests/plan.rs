//! Plans for a published model whose coefficients are made uncertain.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use sistership_model::posterior::Posterior;
use sistership_model::{Effect, Law, Model, Zoo};
use sistership_trial_design::{
    InstrumentAccuracy, PlanError, PlanRequest, TrialPlan, design_trials,
};

/// The Mariner, its coefficients known within a share, and the library.
fn mariner(share: f64) -> (Model, Arc<Law>, Vec<Arc<Effect>>) {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = zoo.find_model("mariner").unwrap();
    let names: Vec<String> = model.coefficients.keys().cloned().collect();
    let values: Vec<f64> = names.iter().map(|name| model.coefficient(name)).collect();
    let deviations = values.iter().map(|value| share * value.abs()).collect();
    let identity = |i: usize, j: usize| f64::from(u8::from(i == j));
    let root_correlation = Posterior::format_rows(names.len(), &identity);
    model.posterior = Some(Posterior { names, values, deviations, root_correlation });
    let law = Arc::clone(zoo.law(&model.law).unwrap());
    (model, law, zoo.effects().cloned().collect())
}

fn planned(share: f64, budget_min: f64, apart: &[&str]) -> Result<TrialPlan, PlanError> {
    let (model, law, library) = mariner(share);
    let apart: Vec<String> = apart.iter().map(|name| (*name).to_owned()).collect();
    design_trials(&PlanRequest {
        model: &model,
        law: &law,
        library: &library,
        budget_s: 60.0 * budget_min,
        apart: &apart,
        sailed: &[],
        instruments: InstrumentAccuracy::SEA_TRIAL,
    })
}

#[test]
fn a_plan_keeps_its_time_and_beats_the_standard_manoeuvres() {
    let plan = planned(0.1, 60.0, &[]).unwrap();
    assert!(plan.takes_min <= 60.0 && plan.standard.takes_min <= 60.0);
    let sum: f64 = plan.trials.iter().map(|trial| trial.takes_min).sum();
    assert!((sum - plan.takes_min).abs() < 1e-9);
    assert!(plan.narrower > plan.standard.narrower, "{plan:#?}");
    assert_eq!(plan.bands.len(), 11);
    for band in &plan.bands {
        assert!(band.after < band.now && band.after > 0.0, "{band:?}");
    }
    let so_far: Vec<f64> = plan.trials.iter().map(|trial| trial.narrower).collect();
    assert!(so_far.is_sorted() && (so_far.last().unwrap() - plan.narrower).abs() < 1e-9);
}

#[test]
fn more_time_narrows_more_and_too_little_is_refused() {
    let narrower = |budget_min| planned(0.1, budget_min, &[]).unwrap().narrower;
    assert!(1.0 - narrower(120.0) < 0.8 * (1.0 - narrower(30.0)));
    let refused = planned(0.1, 1.0, &[]).unwrap_err();
    assert!(matches!(refused, PlanError::NoTrialFits { .. }), "{refused}");
    assert!(matches!(planned(0.1, 0.0, &[]), Err(PlanError::Budget)));
}

#[test]
fn a_current_and_a_rudder_offset_are_told_apart_on_several_headings() {
    let plan = planned(0.02, 60.0, &["current", "rudder-offset"]).unwrap();
    let of = |name: &str| plan.bands.iter().filter(|b| b.figure.starts_with(name)).count();
    assert_eq!((of("current/"), of("rudder-offset/")), (2, 1));
    assert!(plan.trials.iter().all(|trial| trial.heading_deg.is_some()));
    for band in plan.bands.iter().filter(|band| band.unit.is_empty()) {
        assert!(band.after < 0.2 * band.now, "{band:?}");
    }
    let refused = planned(0.02, 60.0, &["tide"]).unwrap_err().to_string();
    assert!(refused.contains("no effect `tide`") && refused.contains("current"), "{refused}");
}
