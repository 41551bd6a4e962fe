//! How much less than they seem to say trials say of an effect, by what it explained of clean
//! trials.

use sistership_model::trial::Channel;
use sistership_model::uncertainty::{FalseAlarmLevel, Uncertainty};

use super::thresholds::THRESHOLDS;
use sistership_residual::EffectCandidate;

/// The factor by which the information on an effect is divided.
pub(super) fn discount(
    uncertainty: Option<&Uncertainty>,
    candidate: &EffectCandidate,
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
    // judged by records of other times instead.
    let own = known
        .false_alarm_levels
        .get(&candidate.key())
        .filter(|_| !is_from_outside(candidate))
        .map(of);
    own.unwrap_or_else(|| {
        let mut all: Vec<f64> = known.false_alarm_levels.values().map(of).collect();
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
