//! Choice of the position of a mixture between source and estimate by simulations of held-out
//! manoeuvres.

use rayon::prelude::*;

use super::evaluation::CandidateEvaluation;
use super::outcome::RefineError;
use super::settings::{Prior, RefinementSettings};

/// Default positions among which the trials choose: source, learned shares and estimate, and
/// halfway between.
const DEFAULT_POSITIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Returns the chosen position; `None` if there is no choice.
///
/// The estimate, which was nearer to most ships than any source (docs/evidence/strangers.md), is
/// evaluated first; with few trials a later position must be better by more than a standard error.
/// The closure evaluates a mixture at one position.
///
/// # Errors
/// Returns an error if it was cancelled.
pub(super) fn choose_position(
    settings: &RefinementSettings,
    weigh: impl Fn(&RefinementSettings) -> Result<Vec<CandidateEvaluation>, RefineError> + Sync,
) -> Result<Option<f64>, RefineError> {
    let mut positions = positions_to_try(settings);
    if positions.len() < 2 {
        return Ok(None);
    }
    // From the estimate (1) to the source (0): a later position must be better to replace an
    // earlier one.
    positions.sort_by(|a, b| b.total_cmp(a));
    let weighed = |position: &f64| {
        let settings =
            RefinementSettings { mixture_positions: vec![*position], ..settings.clone() };
        // A position that cannot be evaluated is skipped; only cancellation ends the choice.
        match weigh(&settings) {
            Err(RefineError::Cancelled) => Err(RefineError::Cancelled),
            weighed => Ok(weighed.ok().and_then(least_error)),
        }
    };
    let all: Vec<Option<CandidateEvaluation>> =
        positions.par_iter().map(weighed).collect::<Result<_, RefineError>>()?;
    let mut best: Option<(f64, &CandidateEvaluation)> = None;
    for (position, weighed) in positions.iter().zip(&all) {
        let Some(weighed) = weighed else { continue };
        if best.is_none_or(|(_, before)| is_better(weighed, before, settings.hold_out_parts)) {
            best = Some((*position, weighed));
        }
    }
    Ok(best.map(|(position, _)| position))
}

/// The positions of the settings; the default ones if the settings name none.
fn positions_to_try(settings: &RefinementSettings) -> Vec<f64> {
    match settings.prior == Prior::Mixture && settings.mixture_positions.is_empty() {
        true => DEFAULT_POSITIONS.to_vec(),
        false => settings.mixture_positions.clone(),
    }
}

/// The evaluation with the least error of those that can be chosen.
fn least_error(weighed: Vec<CandidateEvaluation>) -> Option<CandidateEvaluation> {
    let takeable = weighed.into_iter().filter(|one| one.reason.is_none() && one.error.is_some());
    takeable.min_by(|a, b| a.error.unwrap_or(f64::MAX).total_cmp(&b.error.unwrap_or(f64::MAX)))
}

/// Returns true if a fit has the smaller error; with few trials, by more than a standard error of
/// the difference over their parts (Breiman et al. 1984, section 3.4.3).
fn is_better(new: &CandidateEvaluation, old: &CandidateEvaluation, is_few: bool) -> bool {
    let gains: Vec<f64> =
        new.each.iter().filter_map(|(name, error)| Some(old.each.get(name)? - error)).collect();
    let count = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    if !is_few || gains.len() < 2 {
        return new.error < old.error;
    }
    let variance = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (count - 1.0);
    mean > (variance / count).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Errors by part of a mixture that is best at a position.
    fn weighed(position: f64, best: f64, scatter: f64) -> Vec<CandidateEvaluation> {
        let error = |part: usize| {
            1.0 + (position - best).abs() + scatter * position * if part < 2 { 1.0 } else { -1.0 }
        };
        let each = (0..4).map(|part| (part.to_string(), error(part))).collect();
        let error = Some(1.0 + (position - best).abs());
        vec![CandidateEvaluation {
            error,
            each,
            reason: None,
            ..CandidateEvaluation::with_refusal(String::new())
        }]
    }

    fn position(best: f64, scatter: f64, hold_out_parts: bool) -> Option<f64> {
        let positions = vec![0.0, 0.5, 1.0];
        let settings = RefinementSettings {
            prior: Prior::Mixture,
            mixture_positions: positions,
            hold_out_parts,
            ..RefinementSettings::default()
        };
        let weigh = |one: &RefinementSettings| Ok(weighed(one.mixture_positions[0], best, scatter));
        choose_position(&settings, weigh).unwrap()
    }

    #[test]
    fn the_best_is_taken() {
        assert_eq!(position(0.5, 0.0, true), Some(0.5));
        assert_eq!(position(0.0, 3.0, false), Some(0.0));
    }

    #[test]
    fn few_trials_must_be_clear() {
        assert_eq!(position(0.5, 3.0, true), Some(1.0));
    }

    #[test]
    fn one_position_is_no_choice() {
        let settings =
            RefinementSettings { mixture_positions: vec![0.5], ..RefinementSettings::default() };
        assert_eq!(choose_position(&settings, |_| panic!("weighed")).unwrap(), None);
    }

    #[test]
    fn a_mixture_without_positions_tries_five() {
        let settings =
            RefinementSettings { prior: Prior::Mixture, ..RefinementSettings::default() };
        let weigh = |one: &RefinementSettings| Ok(weighed(one.mixture_positions[0], 0.25, 0.0));
        assert_eq!(choose_position(&settings, weigh).unwrap(), Some(0.25));
    }

    #[test]
    fn what_cannot_be_weighed_is_passed_over() {
        let settings = RefinementSettings {
            mixture_positions: vec![0.0, 1.0],
            ..RefinementSettings::default()
        };
        let weigh = |one: &RefinementSettings| match one.mixture_positions[0] {
            1.0 => Err(RefineError::Data("no estimate".into())),
            other => Ok(weighed(other, 0.0, 0.0)),
        };
        assert_eq!(choose_position(&settings, weigh).unwrap(), Some(0.0));
    }
}
