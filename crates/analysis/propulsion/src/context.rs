//! The propulsion of a fitted model: its law's own propeller, or a surge balance.

use sistership_model::propulsion::Propulsion;
use sistership_model::{Law, Model, Trial};
use sistership_simulation::Ship;
use sistership_simulation::validity::covered_region;

use crate::balance::{PropulsionEvidence, SourcePropeller, model_balance, needs_balance};
use crate::check::{PropulsionFault, check_straight};

/// Inputs for the choice of a model's propulsion.
#[derive(Debug)]
pub struct PropulsionContext<'a> {
    /// The law.
    pub law: &'a Law,
    /// Trials on which the model was fitted.
    pub trials: &'a [&'a Trial],
    /// Source of the refinement, transferred to the ship by a law with a propeller of its own.
    pub source: Option<SourcePropeller<'a>>,
    /// Estimate of the ship from its particulars, of the law `mmg`.
    pub estimate: Option<Model>,
}

impl PropulsionContext<'_> {
    /// Returns the model as it is if its trials stopped or reversed the propeller, or if its law
    /// has a propeller that passes the check; otherwise with a surge balance, if its revolutions
    /// are known. Both have the range of the trials.
    pub fn with_propulsion(&self, model: Model) -> Model {
        let model = self.with_range(model);
        // What was measured with the propeller stopped stays as it was fitted: a balance about a
        // self-propulsion point is no better there, and trials at low speed have no such point.
        let least = model.validity.as_ref().and_then(|region| region.ranges.get("n"));
        let is_measured = least.is_some_and(|[least, _]| *least <= 0.0);
        // A balance has one propeller: the thrust of several stays that of the law.
        if self.law.helm_inputs().next().is_some() {
            return model;
        }
        let has_propeller = !needs_balance(self.law);
        if is_measured || has_propeller && self.propulsion_fault(&model).is_none() {
            return model;
        }
        let balanced = self.with_balance(model.clone());
        // The law's own propeller is kept if a balance would not correct the fault.
        let keeps = has_propeller && self.propulsion_fault(&balanced).is_some();
        if keeps || balanced.propulsion.is_none() { model } else { balanced }
    }

    /// Returns the model with its surge balance, if it has one, recomputed with its posterior.
    pub fn with_posterior(&self, model: Model) -> Model {
        if model.propulsion.is_some() { self.with_balance(model) } else { model }
    }

    /// The model with a surge balance; unchanged if its revolutions are not known.
    fn with_balance(&self, mut model: Model) -> Model {
        // A balance from before must not enter the evidence.
        model.propulsion = None;
        let own = self.estimate.as_ref().and_then(|estimate| estimate.revolutions_rps);
        model.revolutions_rps = model.revolutions_rps.or(own);
        let evidence = PropulsionEvidence {
            model: &model,
            law: self.law,
            source: self.source,
            estimate: self.estimate.as_ref(),
            trials: self.trials,
        };
        model.propulsion = model_balance(&evidence);
        self.with_range(model)
    }

    /// Returns the fault of a model with the propeller stopped or reversed; a model that cannot be
    /// simulated at all is refused elsewhere.
    pub fn propulsion_fault(&self, model: &Model) -> Option<PropulsionFault> {
        Ship::new(model, self.law).ok().and_then(|ship| check_straight(&ship).err())
    }

    /// The model with the range of its trials, including revolutions if it takes them.
    fn with_range(&self, mut model: Model) -> Model {
        let own = self.law.with_effects(&model);
        model.validity = covered_region(self.trials, own.as_ref().unwrap_or(self.law));
        model
    }
}

/// Returns a balance in words.
pub fn describe_balance(propulsion: &Propulsion) -> String {
    let of = |name: &str| propulsion.value(name).unwrap_or(f64::NAN);
    let resistance = propulsion.parameters.get("resistance");
    let deviation = resistance.and_then(|one| one.standard_error).unwrap_or(f64::NAN);
    let on_approach = of("loss") * of("revolutions");
    format!(
        "outside {:.2} to {:.2} 1/s on the approach and {:.2} to {:.2} m/s the surge force is \
         open-water thrust minus resistance: {:.4} kN (standard error {:.4}) at {:.2} m/s and {:.2} 1/s",
        of("order_full_from") + on_approach,
        of("order_full_to") + on_approach,
        of("u_full_from"),
        of("u_full_to"),
        of("resistance") / 1e3,
        deviation / 1e3,
        of("speed"),
        of("revolutions")
    )
}
