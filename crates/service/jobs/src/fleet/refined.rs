//! One member refined: its recipe, and the version that comes of it.

use std::collections::BTreeMap;

use serde_json::Value;
use sistership_fleet::bulk::{BulkRefinement, BulkRequest, refine, refined_model, with_balance};
use sistership_fleet::statistics::{Frame, TrialStatistics};
use sistership_identification::refine::{Fitted, RefineError};
use sistership_model::Model;
use sistership_model::version::FORMAT;

use super::choices::{Rule, Start};
use super::frame::recorded;
use super::kept::made;
use super::order::{Loaded, Order};
use crate::error::DeriveError;
use crate::inputs::Inputs;
use crate::recipe::{FamilyRecipe, Recipe};
use crate::sorted::sorted;
use crate::version::VersionDocument;

/// A member with all that its refinement takes.
pub struct Gathered {
    /// The model that is refined.
    pub model: Model,
    /// Statistics of the trials.
    pub statistics: Vec<TrialStatistics>,
    /// How.
    pub recipe: FamilyRecipe,
}

/// Refines a member: a function of what was gathered and nothing else.
pub fn refined(
    loaded: &Loaded,
    ship: &str,
    gathered: Gathered,
) -> Result<(BulkRefinement, VersionDocument), DeriveError> {
    let Gathered { model, statistics, recipe } = gathered;
    let request = BulkRequest {
        model: &model,
        law: &loaded.law,
        trials: &statistics,
        prior: loaded.prior(),
        settings: &loaded.order.settings,
    };
    let refinement = refine(&request)?;
    let fitted = refinement.coefficients.iter().map(|c| {
        let fitted = Fitted {
            value: c.refined,
            standard_error: c.standard_error,
            prior_deviation: c.prior_deviation,
        };
        (c.name.clone(), fitted)
    });
    let coefficients = fitted.collect::<BTreeMap<_, _>>();
    let refined = refined_model(&model, &coefficients, &loaded.held_by());
    let mut refined = with_balance(refined, &loaded.law);
    // As versions have it that were kept before ships were "it": their bytes stay.
    refined.note = Some("refined from the statistics of her trials".to_owned());
    let report = sorted(serde_json::to_value(&refinement)?);
    finite(&report)?;
    let document = VersionDocument {
        format: FORMAT.to_owned(),
        ship: ship.to_owned(),
        recipe: Recipe::Family(recipe),
        model: refined,
        report,
    };
    Ok((refinement, document))
}

/// What is not a number has no place in a document, where it would read as nothing.
fn finite(report: &Value) -> Result<(), DeriveError> {
    let bad = |key: &str| {
        DeriveError::Refine(RefineError::Data(format!(
            "`{key}` is not a finite number: the trials do not excite it"
        )))
    };
    let lists = ["axes", "coefficients"]
        .into_iter()
        .flat_map(|list| report[list].as_array().into_iter().flatten());
    let mut fields = lists.filter_map(Value::as_object).flatten();
    fields.find(|(_, value)| value.is_null()).map_or(Ok(()), |(key, _)| Err(bad(key)))
}

/// Derives a member's version again, from the samples themselves.
pub async fn derived(
    inputs: &Inputs<'_>,
    ship: &str,
    recipe: &FamilyRecipe,
) -> Result<VersionDocument, DeriveError> {
    let order = Order {
        family: String::new(),
        foundation: recipe.foundation.clone(),
        law_sha256: recipe.law_sha256.clone(),
        start: Start::default(),
        prior: recipe.prior.clone(),
        settings: recipe.settings,
        rule: Rule::default(),
    };
    let loaded = Loaded::of(inputs, order).await?;
    let model = recorded(inputs, &loaded, ship, recipe).await?;
    let frame = Frame::new(&model, &loaded.law, &recipe.law_sha256, recipe.settings.difference_s)?;
    let mut statistics = Vec::with_capacity(recipe.trials.len());
    for trial in &recipe.trials {
        statistics.push(made(&frame, inputs.samples(trial).await?).await?);
    }
    // The recorded program stays in the recipe, as in every other version that is derived again.
    let gathered = Gathered { model, statistics, recipe: recipe.clone() };
    let ship = ship.to_owned();
    Ok(tokio::task::spawn_blocking(move || refined(&loaded, &ship, gathered)).await??.1)
}
