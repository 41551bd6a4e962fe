//! What the trials of a refinement or a training leave open, kept with its model. The command line
//! and the server both come here, so that a version verifies whoever made it.

use std::sync::Arc;

use sistership_diagnosis::{CalibrationSettings, calibrate};
use sistership_identification::refine::Refinement;
use sistership_model::trial::Trial;
use sistership_model::{Effect, Law, Model};
use sistership_model_selection::calibration_samples;

/// Learns what the fitted trials leave open of a refined model; where that fails, the model goes
/// without and a remark says why.
pub fn with_uncertainty(
    mut refinement: Refinement,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Refinement {
    let held_out = &refinement.settings.held_out;
    let fitted: Vec<&Trial> =
        trials.iter().copied().filter(|trial| !held_out.contains(&trial.name)).collect();
    let settings = CalibrationSettings {
        samples: refinement.settings.calibration_samples,
        economical: refinement.settings.economical,
        expected_rates: refinement.settings.expected_rates,
        reading_interval: refinement.settings.reading_interval,
    };
    match calibrate(&refinement.model, law, effects, &fitted, settings) {
        Ok(uncertainty) => refinement.model.uncertainty = Some(uncertainty),
        Err(error) => refinement
            .remarks
            .push(format!("what these trials leave open could not be learned: {error}")),
    }
    refinement
}

/// Learns what trials leave open of a model with a learned correction, whose weights are attached,
/// with the settings of a search; where that fails, the model goes without and its note says why.
pub fn corrected_with_uncertainty(
    model: Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Model {
    let settings = CalibrationSettings {
        samples: Some(calibration_samples()),
        economical: true,
        expected_rates: true,
        reading_interval: true,
    };
    match calibrate(&model, law, effects, trials, settings) {
        Ok(uncertainty) => Model { uncertainty: Some(uncertainty), ..model },
        Err(error) => {
            let note = model.note.clone().unwrap_or_default();
            let why = format!("what its trials leave open could not be learned: {error}");
            Model { note: Some(format!("{note}; {why}")), ..model }
        }
    }
}
