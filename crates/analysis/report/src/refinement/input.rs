//! Input of the report of a refinement.

use sistership_identification::refine::Refinement;
use sistership_model::trial::Trial;
use sistership_model::{Law, Vessel};
use sistership_model_selection::SelectionReport;
use sistership_priors::source::SimilarityRanking;

use crate::rendered::VersionLabel;

/// Input of the report of a refinement.
#[derive(Debug, Clone)]
pub struct RefinementInput<'a> {
    /// Result of the refinement.
    pub refinement: &'a Refinement,
    /// Law of both models.
    pub law: &'a Law,
    /// Target ship.
    pub vessel: &'a Vessel,
    /// All given trials, fitted and held out.
    pub trials: &'a [&'a Trial],
    /// Ranking by similarity, if the source was not named.
    pub similarity: Option<&'a SimilarityRanking>,
    /// Selection report, if the model was selected among candidates.
    pub ladder: Option<&'a SelectionReport>,
    /// Version of the model, if it is stored.
    pub version: Option<VersionLabel>,
}
