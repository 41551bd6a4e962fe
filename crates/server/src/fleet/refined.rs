//! One member refined: her recipe, and the version that comes of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_estimate::refine::{Fitted, RefineError};
use sistership_fleet::bulk::{BulkRefinement, BulkRequest, BulkSettings, refine, refined_model};
use sistership_fleet::statistics::{Frame, TrialStatistics};
use sistership_model::Model;
use sistership_model::version::{FORMAT, RecipeTrial, SourceVersion};

use super::asked::{Rule, Start};
use super::frame::recorded;
use super::kept::made;
use super::order::{Loaded, Order, PriorName};
use crate::derive::{DeriveError, Inputs, sorted};
use crate::version::{Recipe, VersionDocument};
use sistership_model::version::code_revision;

/// How the model of a member is derived from statistics. Everything it starts from is named by the SHA-256 of its bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyRecipe {
    /// Always `family`.
    pub kind: FamilyKind,
    /// The version that she started from: her own, or the foundation.
    pub start: SourceVersion,
    /// Her document, where the foundation was carried over to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ship_sha256: Option<String>,
    /// What the family is founded on.
    pub foundation: SourceVersion,
    /// The family's prior; where absent, the foundation held the coefficients.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prior: Option<PriorName>,
    /// The law's file.
    pub law_sha256: String,
    /// The trials, in the order in which they were taken.
    pub trials: Vec<RecipeTrial>,
    /// Every setting.
    pub settings: BulkSettings,
    /// The program that did it.
    pub code_revision: String,
}

/// The word `family`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FamilyKind {
    /// The only one.
    Family,
}

/// A member with all that her refinement takes.
pub(crate) struct Gathered {
    pub model: Model,
    pub statistics: Vec<TrialStatistics>,
    pub recipe: FamilyRecipe,
}

/// Refines a member: a function of what was gathered and nothing else.
pub(crate) fn refined(loaded: &Loaded, ship: &str, gathered: Gathered) -> Result<(BulkRefinement, VersionDocument), DeriveError> {
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
        let fitted = Fitted { value: c.refined, standard_error: c.standard_error, prior_deviation: c.prior_deviation };
        (c.name.clone(), fitted)
    });
    let mut refined = refined_model(&model, &fitted.collect::<BTreeMap<_, _>>(), &loaded.held_by());
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
        DeriveError::Refine(RefineError::Data(format!("`{key}` is not a finite number: the trials do not excite her")))
    };
    let lists = ["axes", "coefficients"].into_iter().flat_map(|list| report[list].as_array().into_iter().flatten());
    let mut fields = lists.filter_map(Value::as_object).flatten();
    fields.find(|(_, value)| value.is_null()).map_or(Ok(()), |(key, _)| Err(bad(key)))
}

/// Derives a member's version again, from the samples themselves.
pub(crate) async fn derived(inputs: &Inputs<'_>, ship: &str, recipe: &FamilyRecipe) -> Result<VersionDocument, DeriveError> {
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

impl FamilyRecipe {
    /// The recipe of a member of an order.
    pub(crate) fn new(order: &Order, start: SourceVersion, ship_sha256: Option<String>, trials: Vec<RecipeTrial>) -> Self {
        Self {
            kind: FamilyKind::Family,
            start,
            ship_sha256,
            foundation: order.foundation.clone(),
            prior: order.prior.clone(),
            law_sha256: order.law_sha256.clone(),
            trials,
            settings: order.settings,
            code_revision: code_revision().to_owned(),
        }
    }
}
