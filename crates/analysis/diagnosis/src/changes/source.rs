//! What may change within a trial: the effects of the library, those that are there and those that
//! are not, and what acts as a change only.

use super::super::evidence::NormalPrior;
use super::super::hypothesis::priors;
use super::super::misfit::of_shape;
use super::super::search::HypothesisSearch;
use sistership_filtering::{Columns, EffectCandidate};

/// Columns whose size may change.
pub(super) struct ChangeSource {
    /// The effect at its absence: where its size is that of the change.
    pub candidate: EffectCandidate,
    /// Places of its columns in the workspace.
    pub columns: Vec<usize>,
    /// Priors of the change, about none.
    pub priors: Vec<NormalPrior>,
    pub log_prior: f64,
    /// What the information on it is divided by.
    pub discount: f64,
    /// What its own law may leave of its response.
    pub misfit: f64,
}

/// All of them, by the columns of a workspace.
pub(super) fn sources(search: &HypothesisSearch<'_>, columns: &Columns) -> Vec<ChangeSource> {
    let all = columns.candidates.iter().enumerate();
    let changing = all.filter(|(_, candidate)| is_seen_at_its_absence(candidate));
    let one = |(place, candidate): (usize, &EffectCandidate)| ChangeSource {
        columns: columns.places(place).collect(),
        priors: priors(candidate).into_iter().map(about_none).collect(),
        log_prior: search.log_prior(candidate),
        discount: search.discount(candidate),
        misfit: of_shape(candidate),
        candidate: EffectCandidate::absent(&candidate.effect, &candidate.form),
    };
    changing.map(one).collect()
}

/// Lags and plays have no slope where they are absent, and those that are there have a memory,
/// which has no part of a trial for itself.
fn is_seen_at_its_absence(candidate: &EffectCandidate) -> bool {
    candidate.form.lags.is_empty() && candidate.form.bands.is_empty()
}

fn about_none(prior: NormalPrior) -> NormalPrior {
    NormalPrior { mean: 0.0, ..prior }
}
