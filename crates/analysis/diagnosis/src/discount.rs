//! Reduction of the information on an effect by its false-alarm level on clean trials.

use sistership_model::trial::Channel;
use sistership_model::uncertainty::{FalseAlarmLevel, Uncertainty};

use super::thresholds::THRESHOLDS;
use sistership_filtering::EffectCandidate;

/// Divisor of the information on an effect. `listed` are all candidates.
pub(super) fn information_discount(
    uncertainty: Option<&Uncertainty>,
    candidate: &EffectCandidate,
    listed: &[EffectCandidate],
    trials: usize,
) -> f64 {
    let Some(known) = uncertainty else { return THRESHOLDS.effect.unknown_discount };
    let of = |level: &FalseAlarmLevel| level_discount(known, level, trials);
    // An external influence was present on clean trials too, if it is recorded: it is judged by
    // records of other times instead, and by the levels of other forces and flows there, as a law
    // that cannot follow the ship has them; errors of instruments are excluded.
    let of_instruments = |key: &String| {
        let errs = |candidate: &&EffectCandidate| candidate.candidate_key() == *key;
        listed.iter().find(errs).is_some_and(|known| !known.form.measures.is_empty())
    };
    let own = known
        .false_alarm_levels
        .get(&candidate.candidate_key())
        .filter(|_| !is_external(candidate))
        .map(of);
    own.unwrap_or_else(|| {
        let is_effect = |key: &String| !of_instruments(key) && !key.starts_with(PATTERN_KEYS);
        let levels = known.false_alarm_levels.iter().filter(|(key, _)| is_effect(key));
        // The median of the other levels.
        let mut all: Vec<f64> = levels.map(|(_, level)| of(level)).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(1.0)
    })
}

/// Divisor of information by a false-alarm level on the clean trials of a model.
pub(super) fn level_discount(known: &Uncertainty, level: &FalseAlarmLevel, trials: usize) -> f64 {
    // The improvement by one common size grows with the number of trials.
    let together = 1.0 + (level.together - 1.0) * trials as f64 / known.trials.len().max(1) as f64;
    level.each.max(together).max(1.0)
}

/// Start of the keys of the false-alarm levels of patterns of the remainder.
pub(super) const PATTERN_KEYS: &str = "remainder/";

/// Channels of external influences, which do not depend on the ship's motion alone.
pub(super) const EXTERNAL_CHANNELS: [Channel; 4] =
    [Channel::WindSpeed, Channel::WindFrom, Channel::ApparentWindSpeed, Channel::ApparentWindFrom];

/// Returns true if an effect depends on a recorded external signal.
pub(super) fn is_external(candidate: &EffectCandidate) -> bool {
    candidate.form.file.needs.iter().any(|channel| EXTERNAL_CHANNELS.contains(channel))
}
