//! Refinement of one member: its recipe and the resulting version.

use std::collections::BTreeMap;

use serde_json::Value;
use sistership_fleet::bulk::{
    BulkRefinement, BulkRequest, refine_ship, refined_model, with_balance,
};
use sistership_fleet::statistics::{RegressionFrame, TrialStatistics};
use sistership_identification::refine::{FittedCoefficient, RefineError};
use sistership_model::Model;
use sistership_model::version::FORMAT;

use super::choices::{Rule, Start};
use super::frame::recorded_start;
use super::order::{BulkOrder, LoadedOrder};
use super::stored_statistics::compute_statistics;
use crate::error::DeriveError;
use crate::inputs::DerivationInputs;
use crate::recipe::{DerivationRecipe, FamilyRecipe};
use crate::sorted_json::sort_keys;
use crate::version::VersionDocument;

/// Inputs of the refinement of a member.
pub struct MemberInputs {
    /// The model that is refined.
    pub model: Model,
    /// Statistics of the trials.
    pub statistics: Vec<TrialStatistics>,
    /// Its recipe.
    pub recipe: FamilyRecipe,
}

/// Refines a member: a function of its inputs only.
pub fn refine_member(
    loaded: &LoadedOrder,
    ship: &str,
    gathered: MemberInputs,
) -> Result<(BulkRefinement, VersionDocument), DeriveError> {
    let MemberInputs { model, statistics, recipe } = gathered;
    let request = BulkRequest {
        model: &model,
        law: &loaded.law,
        trials: &statistics,
        prior: loaded.prior(),
        settings: &loaded.order.settings,
    };
    let refinement = refine_ship(&request)?;
    let fitted = refinement.coefficients.iter().map(|c| {
        let fitted = FittedCoefficient {
            value: c.refined,
            standard_error: c.standard_error,
            prior_deviation: c.prior_deviation,
        };
        (c.name.clone(), fitted)
    });
    let coefficients = fitted.collect::<BTreeMap<_, _>>();
    // The surge balance is computed anew below, because the coefficients have changed.
    let refined = refined_model(&model, &coefficients, &loaded.describe_prior());
    let mut refined = with_balance(refined, &loaded.law);
    refined.note = Some("refined from the statistics of its trials".to_owned());
    let report = sort_keys(serde_json::to_value(&refinement)?);
    check_finite(&report)?;
    let document = VersionDocument {
        format: FORMAT.to_owned(),
        ship: ship.to_owned(),
        recipe: DerivationRecipe::Family(recipe),
        model: refined,
        report,
    };
    Ok((refinement, document))
}

/// Checks that no number is missing: JSON writes a value that is not finite as null.
fn check_finite(report: &Value) -> Result<(), DeriveError> {
    let bad = |key: &str| {
        DeriveError::Refine(RefineError::Data(format!(
            "`{key}` is not a finite number: the trials do not determine it"
        )))
    };
    let lists = ["axes", "coefficients"]
        .into_iter()
        .flat_map(|list| report[list].as_array().into_iter().flatten());
    let mut fields = lists.filter_map(Value::as_object).flatten();
    fields.find(|(_, value)| value.is_null()).map_or(Ok(()), |(key, _)| Err(bad(key)))
}

/// Derives a member's version again, from the samples themselves instead of stored statistics.
pub async fn derive_member(
    inputs: &DerivationInputs<'_>,
    ship: &str,
    recipe: &FamilyRecipe,
) -> Result<VersionDocument, DeriveError> {
    // Family, start and rule do not enter the bytes of a version; the recipe has the rest.
    let order = BulkOrder {
        family: String::new(),
        foundation: recipe.foundation.clone(),
        law_sha256: recipe.law_sha256.clone(),
        start: Start::default(),
        prior: recipe.prior.clone(),
        settings: recipe.settings,
        rule: Rule::default(),
    };
    let loaded = LoadedOrder::load(inputs, order).await?;
    let model = recorded_start(inputs, &loaded, ship, recipe).await?;
    let frame = RegressionFrame::new(
        &model,
        &loaded.law,
        &recipe.law_sha256,
        recipe.settings.difference_s,
    )?;
    let mut statistics = Vec::with_capacity(recipe.trials.len());
    for trial in &recipe.trials {
        statistics.push(compute_statistics(&frame, inputs.read_samples(trial).await?).await?);
    }
    // The recipe keeps the recorded revision of the program, as in every version that is derived
    // again.
    let gathered = MemberInputs { model, statistics, recipe: recipe.clone() };
    let ship = ship.to_owned();
    Ok(tokio::task::spawn_blocking(move || refine_member(&loaded, &ship, gathered)).await??.1)
}
