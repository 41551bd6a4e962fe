//! Possible changes within a trial: the effects of the library, present or absent, and those that
//! act as a change only.

use super::super::evidence::NormalPrior;
use super::super::hypothesis::candidate_priors;
use super::super::misfit::shape_error;
use super::super::search::HypothesisSearch;
use sistership_filtering::{EffectCandidate, FilterColumns};

/// Columns whose size may change.
pub(super) struct ChangeSource {
    /// The effect at its absence: its size is that of the change.
    pub candidate: EffectCandidate,
    /// Indices of its columns in the workspace.
    pub columns: Vec<usize>,
    /// Priors of the change, with mean zero.
    pub priors: Vec<NormalPrior>,
    pub log_prior: f64,
    /// Divisor of the information on it.
    pub discount: f64,
    /// Relative error of the response of its own law.
    pub misfit: f64,
}

/// All possible changes, by the columns of a workspace.
pub(super) fn change_sources(
    search: &HypothesisSearch<'_>,
    columns: &FilterColumns,
) -> Vec<ChangeSource> {
    let all = columns.candidates.iter().enumerate();
    let changing = all.filter(|(_, candidate)| has_slope_at_absence(candidate));
    let one = |(place, candidate): (usize, &EffectCandidate)| ChangeSource {
        columns: columns.candidate_columns(place).collect(),
        priors: candidate_priors(candidate).into_iter().map(with_zero_mean).collect(),
        log_prior: search.log_prior(candidate),
        discount: search.candidate_discount(candidate),
        misfit: shape_error(candidate),
        candidate: EffectCandidate::at_absence(&candidate.effect, &candidate.form),
    };
    changing.map(one).collect()
}

/// Returns true if an effect has a slope at its absence. Lags and plays have none, and where they
/// are present they have a memory, so that no part of a trial can be separated.
fn has_slope_at_absence(candidate: &EffectCandidate) -> bool {
    candidate.form.lags.is_empty() && candidate.form.bands.is_empty()
}

fn with_zero_mean(prior: NormalPrior) -> NormalPrior {
    NormalPrior { mean: 0.0, ..prior }
}
