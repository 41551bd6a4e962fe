//! Refinement of one ship from the statistics of its trials.

use std::collections::BTreeMap;

use sistership_model::quantity::Quantity;
use sistership_model::vessel::Status;
use sistership_model::{Law, Model};

use super::manoeuvre_check::simulate_check;
use super::outcome::BulkRefinement;
use super::report::refinement_outcome;
use super::request::BulkRequest;
use super::ridge_path::solve_path;
use sistership_identification::refine::{FittedCoefficient, RefineError};
use sistership_propulsion::{PropulsionEvidence, model_balance, needs_balance};

/// Refines a ship, and strengthens the prior by one decade at a time until the model simulates
/// every manoeuvre that the model before does.
///
/// # Errors
/// Returns the errors of the solution; and an error if even the prior's mean cannot be simulated,
/// which is then no prior for this ship.
pub fn refine_ship(request: &BulkRequest<'_>) -> Result<BulkRefinement, RefineError> {
    let BulkRequest { model, law, trials, prior, settings } = *request;
    let solved = solve_path(trials, prior, settings)?;
    let mut before = None;
    for pulled in 0.. {
        let (coefficients, moved) = solved.coefficients_at(pulled);
        let refined = refined_model(model, &coefficients, "bulk");
        // The model before is simulated with the first attempt, at almost no additional cost.
        let asked = [&refined, model];
        let mut sailed =
            simulate_check(&asked[..if before.is_none() { 2 } else { 1 }], law).into_iter();
        let Some(after) = sailed.next() else { break };
        // The model before does not change, so it is simulated once.
        let before = before.get_or_insert_with(|| sailed.next().unwrap_or_default());
        if after.is_no_worse_than(before) {
            let before = before.clone();
            return refinement_outcome(&solved, request, pulled, &coefficients, (before, after));
        }
        // The prior alone is left, and it fails.
        if !moved {
            let failure = after
                .failures
                .first()
                .cloned()
                .unwrap_or_else(|| "a turn or zigzag is not completed".to_owned());
            return Err(RefineError::Diverged(format!(
                "even with the strongest prior the model does not complete a standard manoeuvre \
                 that the previous model completes: {failure}"
            )));
        }
    }
    Err(RefineError::Cancelled)
}

/// Returns the model with a surge balance if the propeller thrust is in its law's coefficients, or
/// if the law has no revolutions. Statistics do not contain the range of the trials, so the balance
/// follows from the law at the approach speed alone.
pub fn with_balance(model: Model, law: &Law) -> Model {
    if model.propulsion.is_some() || !needs_balance(law) {
        return model;
    }
    let evidence =
        PropulsionEvidence { model: &model, law, source: None, estimate: None, trials: &[] };
    Model { propulsion: model_balance(&evidence), ..model }
}

/// Returns the model with exactly these coefficients.
pub fn refined_model(
    model: &Model,
    coefficients: &BTreeMap<String, FittedCoefficient>,
    source: &str,
) -> Model {
    let quantity = |fitted: &FittedCoefficient| Quantity {
        standard_error: Some(fitted.standard_error),
        ..Quantity::new(fitted.value, format!("refined from {source}"))
    };
    let coefficients =
        coefficients.iter().map(|(name, fitted)| (name.clone(), quantity(fitted))).collect();
    // The uncertainty belongs to the coefficients before and is removed.
    Model { status: Status::Refined, coefficients, uncertainty: None, ..model.clone() }
}
