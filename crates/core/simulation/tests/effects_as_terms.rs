//! A model whose effects are terms of its law moves as the model that carries the effects.

#![allow(clippy::unwrap_used)]

use sistership_model::effect::{AppliedEffect, EffectsAsTerms};
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::{Model, Zoo};
use sistership_simulation::plant::{MAX_INPUTS, Plant, PlantWorkspace};
use sistership_simulation::state::{StateVector, at};

/// The Mariner with one effect, its parameters somewhere within their bounds.
fn with(zoo: &Zoo, effect: &str, form: &str) -> Model {
    let effect = zoo.effect(effect).unwrap();
    let form = effect.forms.iter().find(|own| own.file.name == form).unwrap();
    let within = |(place, name): (usize, &String)| {
        let [low, high] = form.parameters[name].bounds;
        (name.clone(), Quantity::new(low + (0.4 + 0.05 * place as f64) * (high - low), "test"))
    };
    let mut model = zoo.find_model("mariner").unwrap();
    model.effects = vec![AppliedEffect {
        name: effect.name.clone(),
        acts_on: effect.acts_on,
        parameters: form.parameters.keys().enumerate().map(within).collect(),
        form: form.file.clone(),
    }];
    model
}

fn rate(model: &Model, law: &Law) -> StateVector {
    let plant = Plant::new(model, law).unwrap();
    let mut state = StateVector::zeros();
    for (place, value) in [(at::U, 6.5), (at::V, -0.8), (at::R, 0.01), (at::PSI, 0.7)] {
        state[place] = value;
    }
    let mut inputs = [0.0; MAX_INPUTS];
    plant
        .input_names()
        .iter()
        .zip(&mut inputs)
        .enumerate()
        .for_each(|(place, (_, input))| *input = 0.3 + 0.2 * place as f64);
    plant.state_rate(&state, &inputs, &mut PlantWorkspace::default())
}

#[test]
fn forces_that_are_linear_become_terms() {
    let zoo = Zoo::load_embedded().unwrap();
    for (effect, form) in [
        ("wind", "measured"),
        ("propeller-asymmetry", "constant"),
        ("extra-resistance", "quadratic"),
    ] {
        let model = with(&zoo, effect, form);
        let law = zoo.law(&model.law).unwrap();
        let mut terms = EffectsAsTerms::new(&model, law).unwrap().unwrap();
        let at_priors = rate(&terms.model, &terms.law);
        for (name, quantity) in &model.effects[0].parameters {
            let term = format!("{effect}/{form}.{name}");
            let own = terms
                .model
                .coefficients
                .iter_mut()
                .find(|(coefficient, _)| coefficient.ends_with(&term))
                .unwrap()
                .1;
            own.value = quantity.value;
        }
        let (expected, found) = (rate(&model, law), rate(&terms.model, &terms.law));
        assert!(
            (expected - found).amax() < 1e-12 * expected.amax(),
            "{effect}: {expected} {found}"
        );
        assert!((at_priors - found).amax() > 1e-9 * expected.amax(), "{effect} does nothing");
        let back = terms.with_fitted_values(&terms.model.coefficients);
        for (name, quantity) in &model.effects[0].parameters {
            assert_eq!(back.effects[0].parameters[name].value, quantity.value, "{effect}: {name}");
        }
        assert_eq!(back.coefficients.len(), model.coefficients.len());
    }
}

#[test]
fn what_is_not_linear_or_no_force_stays_an_effect() {
    let zoo = Zoo::load_embedded().unwrap();
    for (effect, form) in [
        ("wind", "constant"),
        ("current", "constant"),
        ("rudder-offset", "constant"),
        ("yaw-rate-bias", "constant"),
    ] {
        let model = with(&zoo, effect, form);
        assert!(
            EffectsAsTerms::new(&model, zoo.law(&model.law).unwrap()).unwrap().is_none(),
            "{effect}/{form}"
        );
    }
}
