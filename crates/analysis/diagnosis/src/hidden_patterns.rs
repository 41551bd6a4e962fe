//! Patterns in the remainder of a diagnosis after which no segment stands out.

use nalgebra::{DMatrix, DVector};

use super::choose::ConvergedChoice;
use super::coefficient_prior::CoefficientPrior;
use super::discount::level_discount;
use super::hypothesis::JudgedHypothesis;
use super::misfit::form_misfit;
use super::outcome::{OriginKind, RemainderOrigin, RemainderPattern, UnexplainedSegment};
use super::patterns::{PatternInformation, PatternKind};
use super::remainder::trial_remainder;
use super::search::HypothesisSearch;
use super::select::{column_changes, remainder_discrepancies};
use super::thresholds::THRESHOLDS;
use sistership_identification::refine::RefineError;

/// Returns the patterns of a remainder in which no segment stands out, the most evident first: those
/// with more evidence than the differences between published forms of the effects found may have.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown, or the information is not positive.
pub(super) fn remainder_patterns(
    settled: &ConvergedChoice<'_>,
    least_evidence: f64,
) -> Result<Vec<RemainderPattern>, RefineError> {
    let ConvergedChoice { search, base, best, .. } = settled;
    let (workspace, Some(known)) = (&base.workspace, &search.model.uncertainty) else {
        return Ok(Vec::new());
    };
    // Effects that were found may give way as far as they are uncertain: a pattern has to explain
    // what they and the coefficients together cannot.
    let prior = prior_with_effects(&search.fixed, best);
    let each = vec![prior.clone(); workspace.trials.len()];
    let says = PatternInformation::new(
        workspace,
        &remainder_discrepancies(search, workspace),
        &workspace.columns().candidates,
        (&each, Some(&prior)),
    )?;
    let discount = |key: &str| {
        // A pattern without a level on clean trials, as of a channel that they lack, is not tested.
        let level = known.false_alarm_levels.get(key)?;
        Some(level_discount(known, level, workspace.trials.len()))
    };
    let least = least_evidence + form_allowance(search, best)?;
    let length_s = workspace.lpp_m / workspace.speed_m_s;
    let found = says.evident_patterns(workspace, &discount, least).into_iter();
    Ok(found
        .map(|(pattern, evidence)| RemainderPattern {
            channel: workspace.axes()[pattern.axis].velocity_name().to_owned(),
            variable: pattern.kind.name().to_owned(),
            period_s: match pattern.kind {
                PatternKind::Period(period) => Some(period * length_s),
                _ => None,
            },
            evidence,
        })
        .collect())
}

/// Evidence that differences between published forms of the effects found may have.
fn form_allowance(
    search: &HypothesisSearch<'_>,
    best: &JudgedHypothesis,
) -> Result<f64, RefineError> {
    let of = |place: usize| {
        let share = THRESHOLDS.effect.misfits * form_misfit(&best.candidates[place]);
        let evidence = search.discounted_evidence(best, place, 1.0)?;
        Ok(share.powi(2) * evidence.max(0.0))
    };
    (0..best.candidates.len()).map(of).sum()
}

/// Prior of the coefficients and of the effects found, about the estimates of these.
fn prior_with_effects(fixed: &CoefficientPrior, best: &JudgedHypothesis) -> CoefficientPrior {
    let (size, changes) = (fixed.weighted_mean.len(), best.parameter_changes());
    let width = size + changes.len();
    // The smallest positive number keeps the prior of a determined parameter valid.
    let precision = |i: usize| best.covariance[(i, i)].max(f64::MIN_POSITIVE).recip();
    let mut information = DMatrix::zeros(width, width);
    information.view_mut((0, 0), (size, size)).copy_from(&fixed.information);
    (0..changes.len()).for_each(|i| information[(size + i, size + i)] = precision(i));
    let own = changes.iter().enumerate().map(|(i, change)| change * precision(i));
    let weighted_mean = fixed.weighted_mean.iter().copied().chain(own);
    CoefficientPrior { weighted_mean: DVector::from_iterator(width, weighted_mean), information }
}

/// Whole trials as the segments of a pattern, those with the largest remainder first.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn pattern_segments(
    settled: &ConvergedChoice<'_>,
    pattern: &RemainderPattern,
) -> Result<Vec<UnexplainedSegment>, RefineError> {
    let ConvergedChoice { search, base, best, .. } = settled;
    let (workspace, parameters) = (&base.workspace, column_changes(best));
    let discrepancies = remainder_discrepancies(search, workspace);
    let of_trial = |place: usize| {
        trial_remainder((workspace, place), &discrepancies, &parameters, &pattern.channel)
    };
    let each = (0..workspace.trials.len()).map(of_trial).collect::<Result<Vec<_>, _>>()?;
    let mut all: Vec<UnexplainedSegment> = each.into_iter().flatten().collect();
    all.sort_by(|a, b| b.rms_over_noise.total_cmp(&a.rms_over_noise));
    Ok(all)
}

/// Origin of a pattern: the acceleration of its test.
pub(super) fn pattern_origin(pattern: &RemainderPattern, trials: usize) -> RemainderOrigin {
    RemainderOrigin {
        of: OriginKind::Acceleration,
        channel: pattern.channel.clone(),
        evidence: pattern.evidence,
        first_in: trials,
        trials,
    }
}
