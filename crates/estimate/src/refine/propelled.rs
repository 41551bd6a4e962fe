//! Propulsion of a model where its trials do not reach.

use sistership_dynamics::validity::covered;
use sistership_model::Model;
use sistership_propulsion::{Evidence, PropulsionFault, balance, check};
use sistership_sources::transfer::ready;

use super::mixture::estimated;
use super::problem::Problem;

/// The model as it is where it stops and goes astern by its own law, otherwise with a surge
/// balance, and with the range of its trials.
///
/// # Errors
/// What it does with the propeller stopped or reversed all the same.
pub(super) fn propelled(problem: &Problem<'_>, model: Model) -> Result<Model, PropulsionFault> {
    let model = with_range(problem, model);
    let Some(fault) = fault(problem, &model) else { return Ok(model) };
    let model = balanced(problem, model);
    match (model.propulsion.is_some(), fault) {
        (true, _) => self::fault(problem, &model).map_or(Ok(model), Err),
        (false, PropulsionFault::NoRevolutions) => Ok(model),
        (false, fault) => Err(fault),
    }
}

/// The model with a surge balance; as it is where its revolutions are not known.
pub(super) fn balanced(problem: &Problem<'_>, mut model: Model) -> Model {
    let of_ship = problem.target.map(|target| estimated(target, model.speed_m_s));
    let estimate = of_ship.and_then(Result::ok).map(|(estimate, _)| estimate);
    let own = estimate.as_ref().and_then(|estimate| estimate.revolutions_rps);
    model.revolutions_rps = model.revolutions_rps.or(own);
    let evidence = Evidence {
        model: &Model { propulsion: None, ..model.clone() },
        law: problem.law,
        estimate: estimate.as_ref(),
        trials: &problem.whole,
    };
    model.propulsion = balance(&evidence);
    with_range(problem, model)
}

/// What is wrong with a model's propulsion; what cannot sail at all is refused elsewhere.
fn fault(problem: &Problem<'_>, model: &Model) -> Option<PropulsionFault> {
    ready(model, problem.law, &problem.whole).ok().and_then(|ship| check(&ship).err())
}

/// The model with the range of its trials, of revolutions too where it takes them.
fn with_range(problem: &Problem<'_>, mut model: Model) -> Model {
    let own = problem.law.with_effects(&model);
    model.validity = covered(&problem.whole, own.as_ref().unwrap_or(problem.law));
    model
}
