//! Expected information of the candidates.

use nalgebra::DMatrix;
use sistership_diagnosis::{ExpectedInformation, TrialUnknowns as Asked, trial_from_track};
use sistership_filtering::InstrumentNoise;
use sistership_model::{Model, Trial};

use crate::course::SimulatedCandidate;
use crate::design::TrialDesign;
use crate::error::PlanError;
use crate::request::PlanRequest;
use crate::targets::{DesignTarget, gradient_matrix};
use crate::thresholds::THRESHOLDS;
use crate::unknowns::UnknownDeviations;

/// Returns the design of simulated candidates that are recorded like a trial.
///
/// # Errors
/// Returns an error that names what the model or a trial lacks.
pub(crate) fn build_design(
    request: &PlanRequest<'_>,
    bare: &Model,
    unknowns: &UnknownDeviations,
    (courses, like): (&[SimulatedCandidate], &Trial),
    targets: &[DesignTarget],
) -> Result<TrialDesign, PlanError> {
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
    let (before, instruments) = prior_information(request, bare, unknowns, &expected)?;
    let record = |course: &SimulatedCandidate| {
        let heading_rad = course.candidate.heading_deg.to_radians();
        let mut trial = trial_from_track(&course.track, like, heading_rad);
        request.law.set_actuators(&mut trial);
        trial
    };
    let trials: Vec<Trial> = courses.iter().map(record).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    let information = expected.planned_information(&trials, &instruments)?;
    Ok(TrialDesign {
        information: information.iter().map(|one| unknowns.on_deviations(one)).collect(),
        takes_s: courses.iter().map(|course| course.takes_s).collect(),
        gradients: gradient_matrix(targets),
        before,
    })
}

/// Information on the deviations before any planned trial, with that of trials recorded since the
/// model was fitted, and the noise of the instruments.
fn prior_information(
    request: &PlanRequest<'_>,
    model: &Model,
    unknowns: &UnknownDeviations,
    expected: &ExpectedInformation<'_>,
) -> Result<(DMatrix<f64>, InstrumentNoise), PlanError> {
    let size = unknowns.root.nrows();
    // The deviations are independent with unit variances: their information is the identity.
    let mut before = DMatrix::identity(size, size);
    if request.sailed.is_empty() {
        return Ok((before, request.instruments.channel_noise()));
    }
    let (information, noise) = expected.recorded_information(request.sailed)?;
    let fitted = model.uncertainty.as_ref().map(|known| known.trials.as_slice());
    // The information of trials on which the model was fitted is in its posterior already.
    let is_new = |trial: &Trial| !fitted.unwrap_or_default().contains(&trial.name);
    for (trial, information) in request.sailed.iter().zip(&information) {
        if is_new(trial) {
            before += unknowns.on_deviations(information);
        }
    }
    Ok((before, noise))
}
