//! Validation of a model by ITTC 7.5-02-06-03: every quantity of its ship's free-running trials
//! that was not used to make it.

use serde::{Deserialize, Serialize};
use sistership_model::law::Law;
use sistership_model::{Model, Vessel};
use sistership_simulation::{PlantError, Ship};
use utoipa::ToSchema;

use crate::validation::quantity::{QuantityEvidence, ValidatedQuantity, Verdict};
use crate::validation::trial_of_ship::TrialOfShip;
use crate::validation::{published, recorded};

/// Validation of a model against all free-running trials of its ship.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Validation {
    /// Procedure of validation.
    pub procedure: String,
    /// The model.
    pub model: String,
    /// Its law.
    pub law: String,
    /// Number of models drawn from its posterior for U_input; 0 for a model without one.
    pub draws: usize,
    /// Every quantity.
    pub quantities: Vec<ValidatedQuantity>,
    /// Remarks for the interpretation of the quantities.
    pub remarks: Vec<String>,
}

impl Validation {
    /// Returns the number of quantities with a verdict.
    pub fn count_verdicts(&self, verdict: Verdict) -> usize {
        self.quantities.iter().filter(|one| one.verdict == verdict).count()
    }
}

/// Validates a model by published figures of its ship, and by turning circles and zigzags among
/// `trials`; `draws` are models from its posterior, if it has one.
///
/// # Errors
/// Returns an error with the quantity that the model lacks.
pub fn validate(
    vessel: &Vessel,
    model: &Model,
    law: &Law,
    draws: &[Model],
    trials: &[TrialOfShip<'_>],
) -> Result<Validation, PlantError> {
    let ship = unrestricted_ship(model, law)?;
    let sisters =
        draws.iter().map(|draw| unrestricted_ship(draw, law)).collect::<Result<Vec<_>, _>>()?;
    // Published figures first, then recorded trials.
    let mut evidence = published::published_evidence(&ship, &sisters, &vessel.file.free_running);
    evidence.extend(recorded::recorded_evidence(&ship, &sisters, trials));
    Ok(Validation {
        procedure: "ITTC 7.5-02-06-03".to_owned(),
        model: model.name.clone(),
        law: law.name.clone(),
        draws: draws.len(),
        remarks: validation_remarks(&evidence, draws, trials),
        quantities: evidence.into_iter().map(ValidatedQuantity::from).collect(),
    })
}

/// The ship without the range of its trials: trials outside it are validated, too.
fn unrestricted_ship(model: &Model, law: &Law) -> Result<Ship, PlantError> {
    let mut ship = Ship::new(model, law)?;
    ship.disable_excursions();
    Ok(ship)
}

fn validation_remarks(
    evidence: &[QuantityEvidence],
    draws: &[Model],
    trials: &[TrialOfShip<'_>],
) -> Vec<String> {
    let mut remarks = Vec::new();
    if evidence.is_empty() {
        remarks.push(
            "there are no data for a validation: neither published free-running trials of the \
             ship, nor turning circles or zigzags that the model was not fitted to"
                .to_owned(),
        );
    }
    let fitted = trials.iter().filter(|trial| trial.fitted).count();
    if fitted > 0 {
        remarks.push(format!("{fitted} trials are not used, because the model was fitted to them"));
    }
    if draws.is_empty() && !evidence.is_empty() {
        remarks.push(
            "the model has no posterior: U_input is unknown, and U_V is a lower bound".to_owned(),
        );
    }
    if evidence.iter().any(|one| one.data_uncertainty.is_none()) {
        remarks.push(
            "the uncertainty of data from a single record is unknown: repeat the trial".into(),
        );
    }
    remarks
}
