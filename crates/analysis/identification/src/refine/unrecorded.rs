//! Terms of inputs that no trial records.
//!
//! A law may take the wind, or another input, at a default if it is not recorded. Its terms are
//! then redundant with other terms: in still air the apparent wind is the ship's own speed. If they
//! were fitted, they would take over a part of the hull's forces, and give wrong forces in the
//! first trial that records the input. A model that has no values for them is therefore fitted
//! without them.

use std::collections::BTreeSet;

use sistership_formula::Expr;
use sistership_model::effect::input_channel;
use sistership_model::law::Law;
use sistership_model::{Model, Trial};

/// Removes the coefficients from a model that are zero and whose terms depend on an input that no
/// trial records.
pub(super) fn remove_unrecorded_terms(model: &mut Model, law: &Law, trials: &[&Trial]) {
    let unrecorded = unrecorded_inputs(law, trials);
    if unrecorded.is_empty() {
        return;
    }
    let depends = |name: &str| {
        law.unscaled_regressor(name).is_ok_and(|(_, term)| depends_on_any(&term, law, &unrecorded))
    };
    model.coefficients.retain(|name, quantity| quantity.value != 0.0 || !depends(name));
}

/// Names of the inputs with a default whose channel no trial has.
fn unrecorded_inputs<'a>(law: &'a Law, trials: &[&Trial]) -> BTreeSet<&'a str> {
    let nowhere = |name: &str| {
        input_channel(name)
            .is_some_and(|channel| trials.iter().all(|trial| trial.channel(channel).is_none()))
    };
    let inputs = law.inputs.iter().filter(|(name, input)| input.default.is_some() && nowhere(name));
    inputs.map(|(name, _)| name.as_str()).collect()
}

/// Returns true if a formula depends on any of some inputs, directly or by the law's values.
fn depends_on_any(formula: &Expr, law: &Law, inputs: &BTreeSet<&str>) -> bool {
    formula.mentioned_names().into_iter().any(|name| {
        inputs.contains(name)
            || law.values.get(name).is_some_and(|value| depends_on_any(value, law, inputs))
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;
    use sistership_model::trial::Channel;
    use sistership_priors::transfer::blank_model;

    #[test]
    fn wind_terms_need_a_recorded_wind() {
        let zoo = Zoo::load_embedded().unwrap();
        let law = zoo.law("low-speed").unwrap();
        let all = blank_model(law, zoo.vessel("esso-osaka-3m").unwrap(), None).unwrap();
        let (mut calm, mut trial) = (all.clone(), Trial::default());
        remove_unrecorded_terms(&mut calm, law, &[&trial]);
        let forgotten = |name: &str| !calm.coefficients.contains_key(name);
        assert!(forgotten("X_ahead") && forgotten("Y_beam") && !forgotten("Y_v"));
        for channel in [Channel::WindSpeed, Channel::WindFrom] {
            trial.channels.insert(channel, vec![0.0]);
        }
        let mut windy = all.clone();
        remove_unrecorded_terms(&mut windy, law, &[&trial]);
        assert_eq!(windy, all);
    }

    #[test]
    fn what_a_source_knows_stays() {
        let zoo = Zoo::load_embedded().unwrap();
        let law = zoo.law("low-speed").unwrap();
        let mut model = blank_model(law, zoo.vessel("esso-osaka-3m").unwrap(), None).unwrap();
        model.coefficients.get_mut("Y_beam").unwrap().value = -0.001;
        remove_unrecorded_terms(&mut model, law, &[&Trial::default()]);
        assert!(model.coefficients.contains_key("Y_beam"));
    }
}
