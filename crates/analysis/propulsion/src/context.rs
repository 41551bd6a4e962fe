//! The propulsion of a model that was fitted: its law's own, or a surge balance.

use sistership_model::propulsion::Propulsion;
use sistership_model::{Law, Model, Trial};
use sistership_simulation::Ship;
use sistership_simulation::validity::covered;

use crate::balance::{Evidence, balance, needs_balance};
use crate::check::{PropulsionFault, check};

/// What is known when a model's propulsion is chosen.
#[derive(Debug)]
pub struct Context<'a> {
    /// The law.
    pub law: &'a Law,
    /// The trials that the model was fitted to.
    pub trials: &'a [&'a Trial],
    /// The estimate of the ship from its particulars, of the law `mmg`.
    pub estimate: Option<Model>,
}

impl Context<'_> {
    /// The model as it is where its trials stopped or reversed the propeller, or its law has a
    /// propeller of its own that passes the check; otherwise with a surge balance, where its
    /// revolutions are known. Both with the range of the trials.
    pub fn with_propulsion(&self, model: Model) -> Model {
        let model = self.with_range(model);
        // What was measured with the propeller stopped stays as it was fitted: a balance about a
        // self-propulsion point is no better there, and trials at low speed have no such point.
        let least = model.validity.as_ref().and_then(|region| region.ranges.get("n"));
        let is_measured = least.is_some_and(|[least, _]| *least <= 0.0);
        let has_propeller = !needs_balance(self.law);
        if is_measured || has_propeller && self.fault(&model).is_none() {
            return model;
        }
        let balanced = self.with_balance(model.clone());
        // A propeller of the law's own is kept where a balance would not mend it.
        let keeps = has_propeller && self.fault(&balanced).is_some();
        if keeps || balanced.propulsion.is_none() { model } else { balanced }
    }

    /// The model with its surge balance, if it has one, by its posterior.
    pub fn with_posterior(&self, model: Model) -> Model {
        if model.propulsion.is_some() { self.with_balance(model) } else { model }
    }

    /// The model with a surge balance; as it is where its revolutions are not known.
    fn with_balance(&self, mut model: Model) -> Model {
        model.propulsion = None;
        let own = self.estimate.as_ref().and_then(|estimate| estimate.revolutions_rps);
        model.revolutions_rps = model.revolutions_rps.or(own);
        let (estimate, trials) = (self.estimate.as_ref(), self.trials);
        let evidence = Evidence { model: &model, law: self.law, estimate, trials };
        model.propulsion = balance(&evidence);
        self.with_range(model)
    }

    /// What a model does wrong with the propeller stopped or reversed; a model that cannot be
    /// simulated at all is refused elsewhere.
    pub fn fault(&self, model: &Model) -> Option<PropulsionFault> {
        Ship::new(model, self.law).ok().and_then(|ship| check(&ship).err())
    }

    /// The model with the range of its trials, of revolutions too where it takes them.
    fn with_range(&self, mut model: Model) -> Model {
        let own = self.law.with_effects(&model);
        model.validity = covered(self.trials, own.as_ref().unwrap_or(self.law));
        model
    }
}

/// A balance in words.
pub fn words(propulsion: &Propulsion) -> String {
    let of = |name: &str| propulsion.value(name).unwrap_or(f64::NAN);
    let resistance = propulsion.parameters.get("resistance");
    let deviation = resistance.and_then(|one| one.standard_error).unwrap_or(f64::NAN);
    format!(
        "outside {:.2} to {:.2} 1/s and {:.2} to {:.2} m/s surge is a balance of resistance and \
         open-water thrust: {:.4} kN (standard error {:.4}) at {:.2} m/s and {:.2} 1/s",
        of("n_full_from"),
        of("n_full_to"),
        of("u_full_from"),
        of("u_full_to"),
        of("resistance") / 1e3,
        deviation / 1e3,
        of("speed"),
        of("revolutions")
    )
}
