//! The validation of a model by ITTC 7.5-02-06-03: every quantity of its ship's free-running
//! trials that it was not made from.

use serde::{Deserialize, Serialize};
use sistership_model::law::Law;
use sistership_model::{Model, Vessel};
use sistership_simulation::{PlantError, Ship};
use utoipa::ToSchema;

use crate::validation::quantity::{Evidence, ValidatedQuantity, Verdict};
use crate::validation::trial_of_ship::TrialOfShip;
use crate::validation::{published, recorded};

/// A model held against everything that its ship has sailed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Validation {
    /// The procedure.
    pub procedure: String,
    /// The model.
    pub model: String,
    /// Its law.
    pub law: String,
    /// How many models were drawn from its posterior for U_input; 0 for a model without one.
    pub draws: usize,
    /// Every quantity.
    pub quantities: Vec<ValidatedQuantity>,
    /// What must be known to read them.
    pub remarks: Vec<String>,
}

impl Validation {
    /// How many quantities have a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.quantities.iter().filter(|one| one.verdict == verdict).count()
    }
}

/// Validates a model by published figures of its ship, and by turning circles and zigzags among
/// `trials`; `draws` are models from its posterior, if it has one.
///
/// # Errors
/// Names what the model does not give.
pub fn validate(
    vessel: &Vessel,
    model: &Model,
    law: &Law,
    draws: &[Model],
    trials: &[TrialOfShip<'_>],
) -> Result<Validation, PlantError> {
    let ship = ready(model, law)?;
    let sisters = draws.iter().map(|draw| ready(draw, law)).collect::<Result<Vec<_>, _>>()?;
    let mut evidence = published::evidence(&ship, &sisters, &vessel.file.free_running);
    evidence.extend(recorded::evidence(&ship, &sisters, trials));
    Ok(Validation {
        procedure: "ITTC 7.5-02-06-03".to_owned(),
        model: model.name.clone(),
        law: law.name.clone(),
        draws: draws.len(),
        remarks: remarks(&evidence, draws, trials),
        quantities: evidence.into_iter().map(ValidatedQuantity::from).collect(),
    })
}

/// What the trials covered is not asked here.
fn ready(model: &Model, law: &Law) -> Result<Ship, PlantError> {
    let mut ship = Ship::new(model, law)?;
    ship.forget_validity();
    Ok(ship)
}

fn remarks(evidence: &[Evidence], draws: &[Model], trials: &[TrialOfShip<'_>]) -> Vec<String> {
    let mut remarks = Vec::new();
    if evidence.is_empty() {
        remarks.push(
            "there are no data to validate it by: neither published free-running trials of the \
             ship, nor turning circles or zigzags that it was not fitted on"
                .to_owned(),
        );
    }
    let fitted = trials.iter().filter(|trial| trial.fitted).count();
    if fitted > 0 {
        remarks.push(format!("{fitted} trials are left out, since the model was fitted on them"));
    }
    if draws.is_empty() && !evidence.is_empty() {
        remarks.push(
            "the model has no posterior: what its input leaves open is not known, and U_V is a \
             lower bound"
                .to_owned(),
        );
    }
    if evidence.iter().any(|one| one.data_uncertainty.is_none()) {
        remarks.push(
            "the uncertainty of data from one record alone is not known: repeat the trial".into(),
        );
    }
    remarks
}
