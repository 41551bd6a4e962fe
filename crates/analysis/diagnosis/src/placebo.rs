//! Placebo test of an effect that depends on a record: the record of another time, or of another
//! direction, must not explain the trials as well.
//!
//! A record that hardly varies is nearly the same at any other time, so that this is no test. A
//! directional influence is tested by the headings of the trials: from abeam of its true direction,
//! it must explain less.

use std::f64::consts::FRAC_PI_2;

use sistership_model::Trial;
use sistership_model::trial::Channel;

use super::discount::{EXTERNAL_CHANNELS, is_external};
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_identification::refine::RefineError;

/// Returns true if the last effect depends on a recorded external signal, and placebos explain the
/// trials better.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn is_placebo(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    base: &FilteredBase<'_>,
) -> Result<bool, RefineError> {
    let Some(last) = judged.candidates.last().filter(|candidate| is_external(candidate)) else {
        return Ok(false);
    };
    let again = |search: &HypothesisSearch<'_>| {
        // A hypothesis is judged at the level of its screening or the one below.
        let there =
            search.filter_without_candidates(&base.taken, &search.levels[..=judged.level])?;
        Ok(search.judge_candidate(&there, last, judged.level)?.log_evidence)
    };
    any_placebo_exceeds(search, judged.log_evidence, &again)
}

/// Returns true if effects explain the trials better, by a margin, than with any placebo of the
/// external records.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn follow_records(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    margin: f64,
) -> Result<bool, RefineError> {
    let again = |search: &HypothesisSearch<'_>| {
        let there = search.filter_without_candidates(&judged.candidates, &search.levels)?;
        Ok(search.judge_base(&there)?.1.log_evidence)
    };
    Ok(!any_placebo_exceeds(search, judged.log_evidence - margin, &again)?)
}

/// Returns true if the evidence with any of the placebos is above a limit.
fn any_placebo_exceeds(
    search: &HypothesisSearch<'_>,
    limit: f64,
    evidence: &dyn Fn(&HypothesisSearch<'_>) -> Result<f64, RefineError>,
) -> Result<bool, RefineError> {
    for placebo in placebo_trials(search.trials) {
        // Calibration and levels stay those of the true records; only the trials differ.
        let trials: Vec<&Trial> = placebo.iter().collect();
        if evidence(&HypothesisSearch { trials: &trials, ..search.clone() })? > limit {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Trials with records of another time where these vary, or else of another direction.
fn placebo_trials(trials: &[&Trial]) -> Vec<Vec<Trial>> {
    let all = |change: &dyn Fn(&Trial) -> Trial| trials.iter().map(|trial| change(trial)).collect();
    if external_records_vary(trials) {
        THRESHOLDS
            .effect
            .placebo_shifts
            .map(|share| all(&|trial| shift_records(trial, share)))
            .to_vec()
    } else {
        [FRAC_PI_2, -FRAC_PI_2].map(|angle| all(&|trial| turn_directions(trial, angle))).to_vec()
    }
}

/// Returns true if the external records differ from themselves at other times by enough.
fn external_records_vary(trials: &[&Trial]) -> bool {
    let (mut differs, mut is) = (0.0, 0.0);
    for share in THRESHOLDS.effect.placebo_shifts {
        for trial in trials {
            let (own, other) =
                (wind_components(trial), wind_components(&shift_records(trial, share)));
            let square = |[a, b]: [f64; 2]| a * a + b * b;
            differs += own
                .iter()
                .zip(&other)
                .map(|(a, b)| square([a[0] - b[0], a[1] - b[1]]))
                .sum::<f64>();
            is += own.iter().map(|own| square(*own)).sum::<f64>();
        }
    }
    // Two independent records of variance s^2 differ by 2 s^2 on average.
    differs > 2.0 * THRESHOLDS.effect.least_variation.powi(2) * is
}

/// Pairs of channels of a strength and the direction from which it comes.
const WINDS: [(Channel, Channel); 2] = [
    (Channel::WindSpeed, Channel::WindFrom),
    (Channel::ApparentWindSpeed, Channel::ApparentWindFrom),
];

/// Components of a wind over time.
fn wind_components(trial: &Trial) -> Vec<[f64; 2]> {
    let of = |(speed, from): &(Channel, Channel)| {
        let (speed, from) = (trial.channel(*speed)?, trial.channel(*from)?);
        let one = |(speed, from): (&f64, &f64)| [speed * from.cos(), speed * from.sin()];
        Some(speed.iter().zip(from).map(one).collect())
    };
    WINDS.iter().find_map(of).unwrap_or_default()
}

/// Trial with its recorded directions turned by an angle, rad.
fn turn_directions(trial: &Trial, angle_rad: f64) -> Trial {
    let mut trial = trial.clone();
    for (_, from) in WINDS {
        if let Some(values) = trial.channels.get_mut(&from) {
            values.iter_mut().for_each(|value| *value += angle_rad);
        }
    }
    trial
}

/// Trial with its external records shifted by a share of its length; their ends are joined.
fn shift_records(trial: &Trial, share: f64) -> Trial {
    let mut trial = trial.clone();
    for channel in EXTERNAL_CHANNELS {
        if let Some(values) = trial.channels.get_mut(&channel) {
            let by = (share * values.len() as f64) as usize;
            values.rotate_left(by);
        }
    }
    trial
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(speed_m_s: impl Fn(usize) -> f64) -> Trial {
        let mut trial = Trial { t_s: (0..100).map(f64::from).collect(), ..Trial::default() };
        trial.channels.insert(Channel::WindSpeed, (0..100).map(speed_m_s).collect());
        trial.channels.insert(Channel::WindFrom, vec![1.0; 100]);
        trial
    }

    #[test]
    fn a_steady_wind_is_turned_and_a_gusty_one_shifted() {
        let steady = trial(|k| 8.0 + 0.2 * (k as f64).sin());
        let turned = placebo_trials(&[&steady]);
        assert_eq!(turned.len(), 2);
        assert_eq!(turned[0][0].channels[&Channel::WindFrom][0], 1.0 + FRAC_PI_2);
        assert_eq!(
            turned[0][0].channels[&Channel::WindSpeed],
            steady.channels[&Channel::WindSpeed]
        );
        let gusty = trial(|k| if k < 50 { 4.0 } else { 12.0 });
        let shifted = placebo_trials(&[&gusty]);
        assert_eq!(shifted.len(), THRESHOLDS.effect.placebo_shifts.len());
        assert_eq!(shifted[1][0].channels[&Channel::WindSpeed][0], 12.0);
    }
}
