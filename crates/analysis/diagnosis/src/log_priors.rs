//! Prior probability of an effect.

use std::collections::BTreeMap;

use sistership_model::Effect;

use super::DiagnosisInputs;
use super::discount::is_external;
use sistership_filtering::EffectCandidate;

/// Logarithm of the odds of each form against the model alone, by its key: those of the settings,
/// or of the library, divided among the forms of the effect that are candidates. Without any, all
/// effects are equally probable, and the model alone is as probable as all of them.
pub(super) fn log_priors(
    request: &DiagnosisInputs<'_>,
    listed: &[EffectCandidate],
    freed: &[EffectCandidate],
    changing: &[EffectCandidate],
) -> BTreeMap<String, f64> {
    let mut forms: BTreeMap<&str, f64> = BTreeMap::new();
    let all = || listed.iter().chain(freed);
    all().for_each(|candidate| *forms.entry(&candidate.effect).or_default() += 1.0);
    // Effects that act as a change only do not reduce the odds of the others.
    let equal = (forms.len() as f64).recip();
    changing.iter().for_each(|candidate| *forms.entry(&candidate.effect).or_default() += 1.0);
    let log = |candidate: &EffectCandidate| {
        let odds = stated_odds(request, candidate).unwrap_or(equal);
        (candidate.candidate_key(), (odds / forms[candidate.effect.as_str()]).ln())
    };
    all().chain(changing).map(log).collect()
}

/// Returns true if the settings or the library state the odds of any effect.
pub(super) fn states_odds(request: &DiagnosisInputs<'_>) -> bool {
    let stated = |effect: &std::sync::Arc<Effect>| effect.beforehand.is_some();
    !request.settings.prior_odds.is_empty() || request.effects.iter().any(stated)
}

/// Odds of an effect in all its forms; absent where they are not stated.
fn stated_odds(request: &DiagnosisInputs<'_>, candidate: &EffectCandidate) -> Option<f64> {
    let set = request.settings.prior_odds.get(&candidate.effect).copied();
    let is_own = |effect: &&std::sync::Arc<Effect>| effect.name == candidate.effect;
    let of_library = || {
        let known = request.effects.iter().find(is_own)?.beforehand.as_ref()?;
        let recorded = known.odds_where_recorded.filter(|_| is_external(candidate));
        Some(recorded.unwrap_or(known.odds))
    };
    set.or_else(of_library)
}
