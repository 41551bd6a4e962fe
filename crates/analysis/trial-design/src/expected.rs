//! What the candidates are expected to tell.

use nalgebra::DMatrix;
use sistership_diagnosis::{ExpectedInformation, Unknowns as Asked, as_recorded};
use sistership_filtering::Noise;
use sistership_model::{Model, Trial};

use crate::course::Course;
use crate::design::Design;
use crate::error::PlanError;
use crate::request::PlanRequest;
use crate::targets::{Target, gradients};
use crate::thresholds::THRESHOLDS;
use crate::unknowns::Unknowns;

/// The design of courses that are recorded like a trial.
///
/// # Errors
/// Says what the model or a trial lacks.
pub(crate) fn design(
    request: &PlanRequest<'_>,
    bare: &Model,
    unknowns: &Unknowns,
    (courses, like): (&[Course], &Trial),
    targets: &[Target],
) -> Result<Design, PlanError> {
    let asked = Asked {
        model: bare,
        law: request.law,
        library: request.library,
        coefficients: &unknowns.coefficients,
        effects: &unknowns.effects,
        slack: THRESHOLDS.unknown_share,
        discrepancy_level: THRESHOLDS.discrepancy_level,
    };
    let expected = ExpectedInformation::new(asked, like)?;
    let (before, instruments) = known(request, bare, unknowns, &expected)?;
    let record = |course: &Course| {
        as_recorded(&course.track, like, course.candidate.heading_deg.to_radians())
    };
    let trials: Vec<Trial> = courses.iter().map(record).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    let information = expected.planned(&trials, &instruments)?;
    Ok(Design {
        information: information.iter().map(|one| unknowns.on_deviations(one)).collect(),
        takes_s: courses.iter().map(|course| course.takes_s).collect(),
        gradients: gradients(targets),
        before,
    })
}

/// Information on the deviations before any planned trial, with that of trials sailed since the
/// model was fitted, and what the instruments scatter.
fn known(
    request: &PlanRequest<'_>,
    model: &Model,
    unknowns: &Unknowns,
    expected: &ExpectedInformation<'_>,
) -> Result<(DMatrix<f64>, Noise), PlanError> {
    let size = unknowns.root.nrows();
    let mut before = DMatrix::identity(size, size);
    if request.sailed.is_empty() {
        return Ok((before, request.instruments.noise()));
    }
    let (information, noise) = expected.sailed(request.sailed)?;
    let fitted = model.uncertainty.as_ref().map(|known| known.trials.as_slice());
    let is_new = |trial: &Trial| !fitted.unwrap_or_default().contains(&trial.name);
    for (trial, information) in request.sailed.iter().zip(&information) {
        if is_new(trial) {
            before += unknowns.on_deviations(information);
        }
    }
    Ok((before, noise))
}
