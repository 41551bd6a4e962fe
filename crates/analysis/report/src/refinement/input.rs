//! What the report of a refinement is made of.

use sistership_identification::refine::Refinement;
use sistership_model::trial::Trial;
use sistership_model::{Law, Vessel};
use sistership_model_selection::Ladder;
use sistership_priors::source::Similarity;

use crate::rendered::VersionLabel;

/// What the report of a refinement is made of.
#[derive(Debug, Clone)]
pub struct RefinementInput<'a> {
    /// The refinement.
    pub refinement: &'a Refinement,
    /// The law of both models.
    pub law: &'a Law,
    /// The target ship.
    pub vessel: &'a Vessel,
    /// The trials that were given, fitted and held out.
    pub trials: &'a [&'a Trial],
    /// How the source was found, where it was not named.
    pub similarity: Option<&'a Similarity>,
    /// What was tried, where it was searched.
    pub ladder: Option<&'a Ladder>,
    /// The version under which the model is kept, where it is kept.
    pub version: Option<VersionLabel>,
}
