//! Result of a derivation, with its inputs.

use std::sync::Arc;

use bytes::Bytes;
use sistership_identification::refine::{PopulationShip, Refinement, RefinementSettings};
use sistership_model::trial::Trial;
use sistership_model::version;
use sistership_model::{Law, Model, Vessel};

use crate::error::DeriveError;
use crate::library::EffectLibrary;
use crate::recipe::DerivationRecipe;
use crate::sorted_json::sort_keys;
use crate::version::VersionDocument;

/// Callback with the progress of a derivation (0 to 1) and its present step; returns `false` to
/// stop it.
pub type ProgressCallback = Arc<dyn Fn(f64, &str) -> bool + Send + Sync>;

/// Derived version with its by-products.
#[derive(Debug)]
pub struct DerivedVersion {
    /// The version.
    pub document: VersionDocument,
    /// The refinement that produced it, if any.
    pub refined: Option<RefinementRun>,
    /// Weights of its learned correction, if it has one.
    pub weights: Option<Bytes>,
}

/// Refinement with its inputs.
#[derive(Debug)]
pub struct RefinementRun {
    /// The result.
    pub refinement: Refinement,
    /// The inputs.
    pub ingredients: RefinementInputs,
}

/// Inputs of a refinement.
#[derive(Debug)]
pub struct RefinementInputs {
    /// The ship.
    pub target: Vessel,
    /// The source model; a law without coefficients if there is none.
    pub model: Model,
    /// Law of the source model, if it is not the law that is fitted.
    pub source_law: Option<Law>,
    /// Law that is fitted.
    pub law: Law,
    /// Library of effects that the calibration of its uncertainty uses.
    pub library: EffectLibrary,
    /// The trials, in the recipe's order.
    pub trials: Vec<Trial>,
    /// Ships of the population that is the prior.
    pub population: Vec<PopulationShip>,
    /// The settings.
    pub settings: RefinementSettings,
}

impl DerivedVersion {
    /// Creates the result of a derivation that has only a document.
    pub(super) fn from_document(document: VersionDocument) -> Self {
        Self { document, refined: None, weights: None }
    }

    /// Records every setting that was used in the recipe of a refinement, so that later defaults do
    /// not change it. The number of evaluations stays as requested: it is a limit, not what was
    /// used.
    ///
    /// # Errors
    /// Returns an error if a setting is not finite.
    pub fn with_explicit_settings(mut self) -> Result<Self, DeriveError> {
        if let (
            Some(refined),
            DerivationRecipe::Plain(version::VersionRecipe::Refinement { settings, .. }),
        ) = (&self.refined, &mut self.document.recipe)
        {
            let mut used = refined.refinement.settings.clone();
            let asked = refined.ingredients.settings.cma_es.clone().unwrap_or_default().evaluations;
            // The refinement reports the evaluations it used; the recipe keeps the requested limit.
            used.cma_es.iter_mut().for_each(|search| search.evaluations = asked);
            *settings = sort_keys(serde_json::to_value(used)?);
        }
        Ok(self)
    }
}
