//! Propulsion of a model where its trials do not reach.

use sistership_dynamics::validity::covered;
use sistership_model::Model;
use sistership_propulsion::{Evidence, PropulsionFault, balance, check, needs_balance};
use sistership_sources::transfer::ready;

use super::mixture::estimated;
use super::problem::Problem;

/// The model as it is where its law has a propeller, or the trials stopped it, and it stops and goes
/// astern; otherwise with a surge balance. Both with the range of the trials.
///
/// # Errors
/// What it does with the propeller stopped or reversed all the same.
pub(super) fn with_propulsion(
    problem: &Problem<'_>,
    model: Model,
) -> Result<Model, PropulsionFault> {
    let model = with_range(problem, model);
    let least_rps = model.validity.as_ref().and_then(|region| region.ranges.get("n"));
    let is_told = !needs_balance(problem.law) || least_rps.is_some_and(|[least, _]| *least <= 0.0);
    let own = if is_told { fault(problem, &model) } else { Some(PropulsionFault::NoRevolutions) };
    let Some(own) = own else { return Ok(model) };
    let model = with_balance(problem, model);
    match (model.propulsion.is_some(), own) {
        (true, _) => fault(problem, &model).map_or(Ok(model), Err),
        (false, PropulsionFault::NoRevolutions) => Ok(model),
        (false, own) => Err(own),
    }
}

/// The model with a surge balance; as it is where its revolutions are not known.
pub(super) fn with_balance(problem: &Problem<'_>, mut model: Model) -> Model {
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
