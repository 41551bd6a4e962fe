//! How much less than they seem to say trials say of an effect, by what it explained of clean
//! trials.

use sistership_model::trial::Channel;
use sistership_model::uncertainty::{FalseAlarmLevel, Uncertainty};

use super::thresholds::THRESHOLDS;
use sistership_filtering::EffectCandidate;

/// The factor by which the information on an effect is divided. `listed` are all that can be tried.
pub(super) fn discount(
    uncertainty: Option<&Uncertainty>,
    candidate: &EffectCandidate,
    listed: &[EffectCandidate],
    trials: usize,
) -> f64 {
    let Some(known) = uncertainty else { return THRESHOLDS.effect.unknown_discount };
    let of = |level: &FalseAlarmLevel| {
        // What one size of the effect would suit grows with the number of trials.
        let together =
            1.0 + (level.together - 1.0) * trials as f64 / known.trials.len().max(1) as f64;
        level.each.max(together).max(1.0)
    };
    // What comes from outside was there on clean trials too where it is recorded at all: it is
    // judged by records of other times instead, and by what other forces and flows would explain of
    // these, which a law that cannot follow the ship does; an instrument that errs is none of its.
    let of_instruments = |key: &String| {
        let errs = |candidate: &&EffectCandidate| candidate.key() == *key;
        listed.iter().find(errs).is_some_and(|known| !known.form.measures.is_empty())
    };
    let own = known
        .false_alarm_levels
        .get(&candidate.key())
        .filter(|_| !is_from_outside(candidate))
        .map(of);
    own.unwrap_or_else(|| {
        let levels = known.false_alarm_levels.iter().filter(|(key, _)| !of_instruments(key));
        let mut all: Vec<f64> = levels.map(|(_, level)| of(level)).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(1.0)
    })
}

/// The channels that do not come of the ship's motion.
pub(super) const OUTSIDE: [Channel; 4] =
    [Channel::WindSpeed, Channel::WindFrom, Channel::ApparentWindSpeed, Channel::ApparentWindFrom];

/// Whether an effect follows a record of what does not come of the ship's motion.
pub(super) fn is_from_outside(candidate: &EffectCandidate) -> bool {
    candidate.form.file.needs.iter().any(|channel| OUTSIDE.contains(channel))
}
