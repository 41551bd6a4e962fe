//! What a derivation gives, with what it was made of.

use std::sync::Arc;

use bytes::Bytes;
use sistership_identification::refine::{Member, Refinement, Settings};
use sistership_model::trial::Trial;
use sistership_model::version;
use sistership_model::{Law, Model, Vessel};

use crate::error::DeriveError;
use crate::library::Library;
use crate::recipe::Recipe;
use crate::sorted::sorted;
use crate::version::VersionDocument;

/// Told how far a derivation is (0 to 1) and what it does; answers `false` to stop it.
pub type Progress = Arc<dyn Fn(f64, &str) -> bool + Send + Sync>;

/// A derived version, and what it was made with.
#[derive(Debug)]
pub struct Derived {
    /// The version.
    pub document: VersionDocument,
    /// The refinement that gave it, if one did.
    pub refined: Option<Refined>,
    /// The weights of its learned branch, if it has one.
    pub weights: Option<Bytes>,
}

/// A refinement with everything that went into it.
#[derive(Debug)]
pub struct Refined {
    /// What came out.
    pub refinement: Refinement,
    /// What went in.
    pub ingredients: Ingredients,
}

/// What a refinement is made of.
#[derive(Debug)]
pub struct Ingredients {
    /// The ship.
    pub target: Vessel,
    /// The model that is refined; a law without coefficients where there is no source.
    pub model: Model,
    /// Its law, where it is another than what is fitted.
    pub source_law: Option<Law>,
    /// The law of what is fitted.
    pub law: Law,
    /// The library of effects that its calibration is learned with.
    pub library: Library,
    /// The trials, in the recipe's order.
    pub trials: Vec<Trial>,
    /// The ships whose population is the prior.
    pub population: Vec<Member>,
    /// The settings.
    pub settings: Settings,
}

impl Derived {
    /// A document, and nothing beside it.
    pub(super) fn of(document: VersionDocument) -> Self {
        Self { document, refined: None, weights: None }
    }

    /// The same with every setting that was used spelled out in the recipe of a refinement, so that
    /// no later default speaks for it. Evaluations stay as they were asked for: they are a limit,
    /// and not what was spent.
    ///
    /// # Errors
    /// A setting is not finite.
    pub fn spelled_out(mut self) -> Result<Self, DeriveError> {
        if let (Some(refined), Recipe::Plain(version::Recipe::Refinement { settings, .. })) =
            (&self.refined, &mut self.document.recipe)
        {
            let mut used = refined.refinement.settings.clone();
            let asked = refined.ingredients.settings.cma_es.clone().unwrap_or_default().evaluations;
            used.cma_es.iter_mut().for_each(|search| search.evaluations = asked);
            *settings = sorted(serde_json::to_value(used)?);
        }
        Ok(self)
    }
}
