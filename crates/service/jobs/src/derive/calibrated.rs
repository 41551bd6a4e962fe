//! Calibration of the model uncertainty on the trials of a refinement or a training, kept with the
//! model. The command line and the server share it, so that both derive the same version.

use std::sync::Arc;

use sistership_diagnosis::calibrate_model;
use sistership_identification::refine::Refinement;
use sistership_model::trial::Trial;
use sistership_model::{Effect, Law, Model};
use sistership_model_selection::calibration_samples;

/// Calibrates the uncertainty of a refined model on its fitted trials. If that fails, the model has
/// no uncertainty and a remark gives the reason.
pub fn with_uncertainty(
    mut refinement: Refinement,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Refinement {
    // Held-out trials remain independent: they judge the model and must not widen its uncertainty.
    let held_out = &refinement.settings.held_out;
    let fitted: Vec<&Trial> =
        trials.iter().copied().filter(|trial| !held_out.contains(&trial.name)).collect();
    let samples = refinement.settings.calibration_samples;
    match calibrate_model(&refinement.model, law, effects, &fitted, samples) {
        Ok(uncertainty) => refinement.model.uncertainty = Some(uncertainty),
        Err(error) => {
            refinement.remarks.push(format!("the noise model could not be estimated: {error}"))
        }
    }
    refinement
}

/// Calibrates the uncertainty of a model with a learned correction whose weights are attached, with
/// the settings of a search. If that fails, the model has no uncertainty and its note gives the
/// reason.
pub fn correction_with_uncertainty(
    model: Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Model {
    match calibrate_model(&model, law, effects, trials, Some(calibration_samples())) {
        Ok(uncertainty) => Model { uncertainty: Some(uncertainty), ..model },
        Err(error) => {
            let note = model.note.clone().unwrap_or_default();
            let why = format!("the noise model could not be estimated: {error}");
            Model { note: Some(format!("{note}; {why}")), ..model }
        }
    }
}
