#![allow(clippy::unwrap_used)]
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Zoo};
use sistership_priors::transfer::{blank_model, trial_approach};

use crate::refine::family::TermFamily;
use crate::refine::outcome::{Refinement, StepOption};
use crate::refine::request::RefinementSpec;
use crate::refine::selection::refine;
use crate::refine::settings::{EstimationMethod, RefinementSettings};
use crate::testing::simulated_trials;

/// A model with other values of some parameters.
fn with_parameters(model: &Model, values: &[(&str, f64)]) -> Model {
    let mut model = model.clone();
    let all = values.iter().map(|&(name, value)| (name.to_owned(), Quantity::new(value, "truth")));
    model.parameters.extend(all);
    model
}

/// Zigzags of a model with its revolutions.
fn recorded_zigzags(model: &Model, law: &Law) -> Vec<Trial> {
    let mut trials = simulated_trials(model, law, 0.002);
    let n_rps = model.revolutions_rps.unwrap();
    for trial in &mut trials {
        trial.channels.insert(Channel::N, vec![n_rps; trial.t_s.len()]);
    }
    trials
}

fn refined(source: &Model, law: &Law, trials: &[Trial], method: EstimationMethod) -> Refinement {
    let zoo = Zoo::load_embedded().unwrap();
    let trials: Vec<&Trial> = trials.iter().collect();
    // Without asymmetric terms, which could take up a part of what is wrong.
    let families = vec![TermFamily::Own];
    let settings = RefinementSettings { method, families, ..RefinementSettings::default() };
    let request = RefinementSpec {
        target: zoo.vessel("kvlcc2-7m").unwrap(),
        source,
        source_law: None,
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    refine(&request, &|_, _| true).unwrap()
}

#[test]
fn interaction_factors_are_fitted_within_their_range() {
    let zoo = Zoo::load_embedded().unwrap();
    let source = zoo.find_model("kvlcc2-7m").unwrap();
    let law = zoo.law(&source.law).unwrap();
    // More force by the same rudder, which no coefficient of the hull can give.
    let moved = [("w_P0", 0.3), ("a_H", 0.6)];
    let trials = recorded_zigzags(&with_parameters(&source, &moved), law);
    let weak = refined(&source, law, &trials, EstimationMethod::Weak);
    let fitted = refined(&source, law, &trials, EstimationMethod::Trajectory);
    assert_eq!(weak.model.parameters, weak.transferred.parameters, "the weak form keeps them");
    let error = |options: &[StepOption], start: &str| {
        let named = options.iter().filter(|option| option.step.starts_with(start));
        named.filter_map(|option| option.error).fold(f64::INFINITY, f64::min)
    };
    let (before, after) = (error(&weak.options, ""), error(&fitted.options, "trajectory"));
    assert!(after < before, "{before} {:#?}", fitted.options);
    for (name, prior) in law.parameter_priors() {
        let [low, high] = prior.range;
        let value = fitted.model.parameters[name].value;
        assert!((low..=high).contains(&value), "{name}: {value}");
    }
}

#[test]
fn a_typical_ship_holds_what_small_zigzags_do_not_tell() {
    let zoo = Zoo::load_embedded().unwrap();
    let truth = zoo.find_model("kvlcc2-7m").unwrap();
    let trials = recorded_zigzags(&truth, zoo.law(&truth.law).unwrap());
    let trials: Vec<&Trial> = trials.iter().collect();
    let law = zoo.law("modular").unwrap();
    let typical = blank_model(law, zoo.vessel("kvlcc2-7m").unwrap(), trial_approach(&trials));
    let typical = typical.unwrap();
    let mut zero = typical.clone();
    zero.coefficients.values_mut().for_each(|one| *one = Quantity::new(0.0, "unknown"));
    let settings = RefinementSettings {
        method: EstimationMethod::Trajectory,
        families: vec![TermFamily::Own],
        strengths: vec![1e-2, 1e-4, 1e-6, 1e-8],
        // Fitted on 10 and 20 deg to one side each, judged at 30.
        held_out: vec!["trial-1".to_owned(), "trial-2".to_owned()],
        ..RefinementSettings::default()
    };
    let error = |source: &Model| {
        let request = RefinementSpec {
            target: zoo.vessel("kvlcc2-7m").unwrap(),
            source,
            source_law: None,
            law,
            trials: &trials,
            population: &[],
            settings: &settings,
        };
        let made = refine(&request, &|_, _| true).unwrap();
        let gone: Vec<&String> = typical
            .coefficients
            .keys()
            .filter(|name| !made.model.coefficients.contains_key(*name))
            .collect();
        assert!(
            gone.iter().all(|name| name.contains("ahead") || name.contains("beam")),
            "{gone:?}"
        );
        made.held_out.refined["psi"]
    };
    let (with_typical, with_zero) = (error(&typical), error(&zero));
    assert!(with_typical < 0.8 * with_zero, "{with_typical} {with_zero}");
}
