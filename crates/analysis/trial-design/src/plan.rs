//! Steps from a request to a trial design.

use rayon::prelude::*;
use sistership_model::Model;
use sistership_simulation::Ship;

use crate::candidates::all_candidates;
use crate::course::{SimulatedCandidate, simulate_candidates};
use crate::design::TrialDesign;
use crate::error::PlanError;
use crate::expected::build_design;
use crate::outcome::TrialPlan;
use crate::report::report_plan;
use crate::request::PlanRequest;
use crate::search::best_design;
use crate::setting::DesignContext;
use crate::targets::design_targets;
use crate::thresholds::THRESHOLDS;
use crate::unknowns::UnknownDeviations;

/// Returns the trials that reduce the uncertainty bands of the IMO criteria, and of the effects to
/// be distinguished, most.
///
/// # Errors
/// Returns an error that names what the request, the model or its law lacks, or one if no trial
/// fits into the budget.
pub fn design_trials(request: &PlanRequest<'_>) -> Result<TrialPlan, PlanError> {
    request.check_inputs()?;
    let DesignContext { bare, ship, like, effects, mut remarks } = DesignContext::new(request)?;
    let unknowns = UnknownDeviations::new(request.model, effects)?;
    remarks.extend(unknowns.remark.clone());
    let courses = simulate_all_candidates(&ship, &bare, !request.apart.is_empty())?;
    let nothing = || PlanError::NothingOpen(request.model.name.clone());
    let (targets, unreached) = design_targets(&bare, request.law, &unknowns).ok_or_else(nothing)?;
    if targets.is_empty() {
        return Err(nothing());
    }
    remarks.extend(unreached.iter().map(|name| format!("{name}: not reached by the model")));
    let design = build_design(request, &bare, &unknowns, (&courses, &like), &targets)?;
    let chosen = best_design(&design, request.budget_s);
    if chosen.is_empty() {
        return Err(budget_error(request, &design));
    }
    Ok(report_plan(request, &design, (&courses, &chosen), &targets, remarks))
}

fn budget_error(request: &PlanRequest<'_>, design: &TrialDesign) -> PlanError {
    let shortest_s = design.takes_s.iter().copied().fold(f64::INFINITY, f64::min);
    PlanError::NoTrialFits { budget_min: request.budget_s / 60.0, shortest_min: shortest_s / 60.0 }
}

/// All candidates that the model can simulate.
fn simulate_all_candidates(
    ship: &Ship,
    model: &Model,
    has_outside: bool,
) -> Result<Vec<SimulatedCandidate>, PlanError> {
    // Candidates of one speed are simulated in lockstep.
    let mut by_speed: Vec<Vec<_>> = vec![Vec::new(); THRESHOLDS.speeds.len()];
    for candidate in all_candidates(has_outside) {
        let place = THRESHOLDS.speeds.iter().position(|speed| *speed == candidate.speed);
        place.into_iter().for_each(|place| by_speed[place].push(candidate));
    }
    let sailed: Vec<Result<SimulatedCandidate, String>> =
        by_speed.par_iter().flat_map_iter(|some| simulate_candidates(ship, some)).collect();
    let reason = sailed.iter().find_map(|course| course.as_ref().err()).cloned();
    let all: Vec<SimulatedCandidate> = sailed.into_iter().flatten().collect();
    // Some candidates may fail, such as hard turns of an unstable model; an error only if all do.
    match reason.filter(|_| all.is_empty()) {
        Some(reason) => Err(PlanError::SailsNone { model: model.name.clone(), reason }),
        None => Ok(all),
    }
}
