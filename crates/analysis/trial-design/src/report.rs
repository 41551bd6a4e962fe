//! Report of a design.

use sistership_simulation::manoeuvre::Manoeuvre;
use sistership_simulation::state::at;

use crate::candidates::standard_indices;
use crate::course::SimulatedCandidate;
use crate::design::TrialDesign;
use crate::outcome::{ExpectedBand, PlannedTrial, StandardProgramme, TrialPlan};
use crate::request::PlanRequest;
use crate::targets::DesignTarget;
use crate::thresholds::THRESHOLDS;

/// Half the width of a band that holds 95 % of a normal distribution, by its deviation.
const HALF_WIDTH: f64 = 1.96;

/// Reports the selected candidates, the bands that are expected after them, and the IMO manoeuvres
/// for comparison.
pub(crate) fn report_plan(
    request: &PlanRequest<'_>,
    design: &TrialDesign,
    (courses, chosen): (&[SimulatedCandidate], &[usize]),
    targets: &[DesignTarget],
    remarks: Vec<String>,
) -> TrialPlan {
    let (standard, bands) = compare_standard(request, design, (courses, chosen), targets);
    TrialPlan {
        model: request.model.name.clone(),
        budget_min: request.budget_s / 60.0,
        takes_min: design.lasts_s(chosen) / 60.0,
        trials: planned_trials(request, design, courses, chosen),
        narrower: design.relative_narrowing(chosen),
        bands,
        standard,
        instruments: request.sailed.is_empty().then_some(request.instruments),
        remarks,
    }
}

/// Planned trials of an order of candidates.
fn planned_trials(
    request: &PlanRequest<'_>,
    design: &TrialDesign,
    courses: &[SimulatedCandidate],
    order: &[usize],
) -> Vec<PlannedTrial> {
    // Without effects to be distinguished the heading has no influence.
    let by_heading = !request.apart.is_empty();
    let one = |(place, &which): (usize, &usize)| {
        let course = &courses[which];
        let (rudder_deg, switch_deg) = match course.candidate.manoeuvre {
            Manoeuvre::Turn { rudder } => (rudder, None),
            Manoeuvre::Zigzag { rudder, switch } => (rudder, Some(switch)),
        };
        PlannedTrial {
            manoeuvre: course.candidate.manoeuvre.to_string(),
            rudder_deg,
            switch_deg,
            speed_m_s: course.track.states.first().map_or(0.0, |state| state[at::U]),
            heading_deg: by_heading.then_some(course.candidate.heading_deg),
            manoeuvre_min: course.manoeuvre_s / 60.0,
            takes_min: course.takes_s / 60.0,
            narrower: design.relative_narrowing(&order[..=place]),
        }
    };
    order.iter().enumerate().map(one).collect()
}

/// IMO manoeuvres within the budget, and the bands after the design and after these.
fn compare_standard(
    request: &PlanRequest<'_>,
    design: &TrialDesign,
    (courses, chosen): (&[SimulatedCandidate], &[usize]),
    targets: &[DesignTarget],
) -> (StandardProgramme, Vec<ExpectedBand>) {
    let all: Vec<_> = courses.iter().map(|course| course.candidate).collect();
    // The comparison uses the same budget.
    let sailed = fill_in_order(design, &standard_indices(&all), request.budget_s);
    let of = |places: &[usize]| {
        design.target_deviations(design.information_with(places)).unwrap_or_default()
    };
    let (now, after, after_standard) = (of(&[]), of(chosen), of(&sailed));
    let half =
        |deviations: &[f64], k: usize| HALF_WIDTH * deviations.get(k).copied().unwrap_or(f64::NAN);
    let band = |(k, target): (usize, &DesignTarget)| ExpectedBand {
        figure: target.name.clone(),
        unit: target.unit.to_owned(),
        value: target.value,
        now: half(&now, k),
        after: half(&after, k),
        after_standard: half(&after_standard, k),
    };
    let programme = StandardProgramme {
        trials: planned_trials(request, design, courses, &sailed),
        takes_min: design.lasts_s(&sailed) / 60.0,
        narrower: design.relative_narrowing(&sailed),
    };
    (programme, targets.iter().enumerate().map(band).collect())
}

/// Candidates in order, repeated from the first, until one does not fit.
fn fill_in_order(design: &TrialDesign, order: &[usize], budget_s: f64) -> Vec<usize> {
    let mut sailed = Vec::new();
    for &place in order.iter().cycle().take(THRESHOLDS.most_trials) {
        sailed.push(place);
        if design.lasts_s(&sailed) > budget_s {
            sailed.pop();
            break;
        }
    }
    sailed
}
