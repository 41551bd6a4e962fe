//! The coefficients once more, with the effects in place: what they had taken over from what was missing they give back.

use std::borrow::Cow;

use sistership_dynamics::plant::dressed;
use sistership_model::effect::ActsOn;
use sistership_model::law::Law;
use sistership_model::{Model, Trial, particulars};

use crate::refine::{Blocks, fit, trial_moments};
use crate::regression::{Choice, Moments};
use crate::transfer::approach_of;

/// Strengths of the prior that are weighed; the first leaves the coefficients as they are.
pub(super) const STRENGTHS: [Option<f64>; 5] = [None, Some(1000.0), Some(100.0), Some(10.0), Some(1.0)];

/// A model that carries effects, its coefficients refitted on trials with its own as the prior; as it is where that cannot be
/// done: instruments that err would mislead the regression.
pub(super) fn refitted<'a>(model: &'a Model, law: &Law, trials: &[&Trial], strength: Option<f64>) -> Cow<'a, Model> {
    let errs = model.effects.iter().any(|effect| effect.acts_on == ActsOn::Measurement);
    let fitted = strength.filter(|_| !errs).and_then(|lambda| with_coefficients(model, law, trials, lambda));
    fitted.map_or(Cow::Borrowed(model), Cow::Owned)
}

fn with_coefficients(model: &Model, law: &Law, trials: &[&Trial], lambda: f64) -> Option<Model> {
    let law = dressed(model, law).ok()?;
    let blocks = Blocks::new(model, &law).ok()?;
    let speed_m_s = approach_of(trials).map(|approach| approach.speed_m_s).or(model.speed_m_s)?;
    let difference_s = 0.1 * particulars::value(&model.particulars, "lpp_m")? / speed_m_s;
    let of = |trial: &&Trial| trial_moments(&blocks, trial, Some(difference_s)).ok();
    let each: Vec<Vec<Moments>> = trials.iter().map(of).collect::<Option<_>>()?;
    let mut total = each.first()?.clone();
    for moments in &each[1..] {
        total.iter_mut().zip(moments).for_each(|(sum, more)| sum.merge(more));
    }
    let choices = blocks.blocks.iter().map(|block| vec![Choice { lambda, alpha: 0.0 }; block.axes.len()]).collect();
    let mut model = model.clone();
    for (name, fitted) in fit(&blocks, &total, &model, &choices).coefficients {
        let quantity = model.coefficients.get_mut(&name)?;
        (quantity.value, quantity.standard_error) = (fitted.value, Some(fitted.standard_error));
    }
    // What was known of the coefficients before is not known of these.
    model.uncertainty = None;
    Some(model)
}
