//! Improvement of the fit by effects on trials that do not have them.
//!
//! The discrepancy is a random motion, but the error of a law is not, and an effect that resembles
//! this error would be accepted. The frequency of that is measured: on each clean trial, under
//! coefficients fitted on the others, and on all together.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_model::uncertainty::FalseAlarmLevel;

use super::super::coefficient_prior::CoefficientPrior;
use super::super::evidence::{MarginalInformation, NormalPrior};
use super::super::hypothesis::candidate_priors;
use super::super::linearised_trials::LinearisedTrials;
use super::super::thresholds::THRESHOLDS;
use super::trial_information::TrialInformation;
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;

/// False-alarm levels by `effect/form`.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn false_alarm_levels(
    workspace: &LinearisedTrials<'_>,
    (known, but_one): (&TrialInformation<'_>, &[CoefficientPrior]),
    candidates: &[EffectCandidate],
) -> Result<BTreeMap<String, FalseAlarmLevel>, RefineError> {
    let size = known.fixed.weighted_mean.len();
    // Coefficients first, then the columns of the candidates in their order, which `first` counts
    // below.
    let columns: Vec<usize> = candidates
        .iter()
        .flat_map(|candidate| workspace.columns().matching_columns(candidate))
        .collect();
    let places: Vec<usize> = (0..size).chain(columns).collect();
    let alone = |trial: usize| {
        MarginalInformation::new(&known.grams[trial].select_columns(&places), &but_one[trial])
    };
    let single: Vec<MarginalInformation> =
        (0..known.grams.len()).into_par_iter().map(alone).collect::<Result<_, _>>()?;
    let Some(total) = single.iter().cloned().reduce(MarginalInformation::add_information) else {
        return Ok(BTreeMap::new());
    };
    let mut first = 0;
    let mut of = |candidate: &EffectCandidate| {
        let columns: Vec<usize> = (first..first + candidate.at.len()).collect();
        first += candidate.at.len();
        let fixing: Vec<NormalPrior> = candidate_priors(candidate);
        let each = explained_ratio(single.iter(), &columns, &fixing);
        let together = explained_ratio(std::iter::once(&total), &columns, &fixing);
        // Rounded, so that a stored level does not depend on the last digits of the arithmetic.
        let rounded = |x: f64| {
            (THRESHOLDS.calibration.rounding * x).round() / THRESHOLDS.calibration.rounding
        };
        (
            candidate.candidate_key(),
            FalseAlarmLevel { each: rounded(each), together: rounded(together) },
        )
    };
    Ok(candidates.iter().map(&mut of).collect())
}

/// Improvement of the fit by that expected by chance; one where no trial has information on the
/// effect.
fn explained_ratio<'a>(
    reduced: impl Iterator<Item = &'a MarginalInformation>,
    columns: &[usize],
    fixing: &[NormalPrior],
) -> f64 {
    let parts = reduced.filter_map(|reduced| reduced.explained_and_chance(columns, fixing));
    let (explained, chance) = parts.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    if chance > THRESHOLDS.calibration.least_chance { explained / chance } else { 1.0 }
}
