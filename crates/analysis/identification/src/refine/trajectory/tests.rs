#![allow(clippy::unwrap_used)]
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Zoo};

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
    // The source holds the coefficients, so that parameters must explain the difference.
    let strengths = vec![10.0];
    let settings =
        RefinementSettings { method, families, strengths, ..RefinementSettings::default() };
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

fn chosen_option(refinement: &Refinement) -> &StepOption {
    refinement.options.iter().find(|option| option.chosen).unwrap()
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
    let (before, after) = (chosen_option(&weak), chosen_option(&fitted));
    assert!(after.step.starts_with("trajectory"), "{:#?}", fitted.options);
    assert!(after.error < before.error, "{before:?} {after:?}");
    assert_eq!(weak.model.parameters, weak.transferred.parameters);
    for (name, prior) in law.parameter_priors() {
        let change = fitted.coefficients.iter().find(|one| one.name == *name).unwrap();
        let [low, high] = prior.range;
        assert!((low..=high).contains(&change.refined), "{name}: {}", change.refined);
        assert_eq!(fitted.model.parameters[name].value, change.refined);
        assert!(change.standard_error > 0.0, "{name} has an error");
    }
    let posterior = fitted.model.valid_posterior().unwrap();
    assert!(posterior.names.iter().any(|name| name == "w_P0"));
}
