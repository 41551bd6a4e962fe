//! Steps from a request to a trial design.

use rayon::prelude::*;
use sistership_model::Model;
use sistership_simulation::Ship;

use crate::candidates::candidates;
use crate::course::{Course, courses};
use crate::design::Design;
use crate::error::PlanError;
use crate::expected::design;
use crate::outcome::Plan;
use crate::request::PlanRequest;
use crate::said::said;
use crate::search::best;
use crate::setting::Setting;
use crate::targets::targets;
use crate::thresholds::THRESHOLDS;
use crate::unknowns::Unknowns;

/// Returns the trials that reduce the uncertainty bands of the IMO criteria, and of the effects to
/// be distinguished, most.
///
/// # Errors
/// Returns an error that names what the request, the model or its law lacks, or one if no trial
/// fits into the budget.
pub fn plan(request: &PlanRequest<'_>) -> Result<Plan, PlanError> {
    request.check()?;
    let Setting { bare, ship, like, effects, mut remarks } = Setting::new(request)?;
    let unknowns = Unknowns::new(request.model, effects)?;
    remarks.extend(unknowns.remark.clone());
    let courses = all_courses(&ship, &bare, !request.apart.is_empty())?;
    let nothing = || PlanError::NothingOpen(request.model.name.clone());
    let (targets, unreached) = targets(&bare, request.law, &unknowns).ok_or_else(nothing)?;
    if targets.is_empty() {
        return Err(nothing());
    }
    remarks.extend(unreached.iter().map(|name| format!("{name}: the model does not reach it")));
    let design = design(request, &bare, &unknowns, (&courses, &like), &targets)?;
    let chosen = best(&design, request.budget_s);
    if chosen.is_empty() {
        return Err(too_short(request, &design));
    }
    Ok(said(request, &design, (&courses, &chosen), &targets, remarks))
}

fn too_short(request: &PlanRequest<'_>, design: &Design) -> PlanError {
    let shortest_s = design.takes_s.iter().copied().fold(f64::INFINITY, f64::min);
    PlanError::NoTrialFits { budget_min: request.budget_s / 60.0, shortest_min: shortest_s / 60.0 }
}

/// All candidates that the model can simulate.
fn all_courses(ship: &Ship, model: &Model, has_outside: bool) -> Result<Vec<Course>, PlanError> {
    // Candidates of one speed are simulated in lockstep.
    let mut by_speed: Vec<Vec<_>> = vec![Vec::new(); THRESHOLDS.speeds.len()];
    for candidate in candidates(has_outside) {
        let place = THRESHOLDS.speeds.iter().position(|speed| *speed == candidate.speed);
        place.into_iter().for_each(|place| by_speed[place].push(candidate));
    }
    let sailed: Vec<Result<Course, String>> =
        by_speed.par_iter().flat_map_iter(|some| courses(ship, some)).collect();
    let reason = sailed.iter().find_map(|course| course.as_ref().err()).cloned();
    let all: Vec<Course> = sailed.into_iter().flatten().collect();
    // Some candidates may fail, such as hard turns of an unstable model; an error only if all do.
    match reason.filter(|_| all.is_empty()) {
        Some(reason) => Err(PlanError::SailsNone { model: model.name.clone(), reason }),
        None => Ok(all),
    }
}
