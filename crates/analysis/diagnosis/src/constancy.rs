//! Constancy of effects in time. An effect that only resembles the missing one is needed with one
//! size here and another there: the pieces of the trials, each by itself, have different estimates.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::coefficient_prior::CoefficientPrior;
use super::discount::is_external;
use super::evidence::{MarginalInformation, NormalPrior};
use super::filtered_base::FilteredBase;
use super::hypothesis::{JudgedHypothesis, candidate_priors};
use super::misfit::misfit_share;
use super::placebo::follow_records;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_filtering::GramMatrix;
use sistership_identification::refine::RefineError;

/// Indices of the effects that are not constant. An effect of a recorded external signal may vary
/// where records of other times explain the trials less ([`follow_records`]), since an unknown
/// cause does not follow that record.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn inconstant_effects(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    judged: &JudgedHypothesis,
    margin: f64,
) -> Result<Vec<usize>, RefineError> {
    let varies = size_variations(search, base, judged)?;
    let mut places: Vec<usize> =
        (0..varies.len()).filter(|&place| varies[place] > variation_limit(judged, place)).collect();
    let is_outside = |place: &usize| is_external(&judged.candidates[*place]);
    if places.iter().any(is_outside) && follow_records(search, judged, margin)? {
        places.retain(|place| !is_outside(place));
    }
    Ok(places)
}

/// Returns true if the effect that a hypothesis has added last is not constant. One of a recorded
/// external signal is judged by its records instead.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn is_last_inconstant(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    judged: &JudgedHypothesis,
) -> Result<bool, RefineError> {
    let last = judged.candidates.len() - 1;
    if is_external(&judged.candidates[last]) {
        return Ok(false);
    }
    Ok(size_variations(search, base, judged)?[last] > variation_limit(judged, last))
}

/// Largest variation of the size of an effect that is constant: a form that differs from the true
/// one also needs another size in other motions.
fn variation_limit(judged: &JudgedHypothesis, place: usize) -> f64 {
    THRESHOLDS.constancy.limit.max(misfit_share(&judged.candidates[place]))
}

/// Variation of the size of each effect between the pieces of the trials.
fn size_variations(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    judged: &JudgedHypothesis,
) -> Result<Vec<f64>, RefineError> {
    let pieces = base
        .linearise_hypothesis(&search.calibrated_model, &judged.linearised_at)?
        .products_per_piece(judged.level, THRESHOLDS.constancy.pieces)?;
    let known = prior_after_trials(&search.fixed, judged);
    // Each piece alone, with the coefficients as all trials determine them.
    let reduced: Vec<MarginalInformation> = pieces
        .iter()
        .map(|piece| MarginalInformation::new(piece, &known))
        .collect::<Result<_, _>>()?;
    let one = |place: usize| {
        let discount = search.candidate_discount(&judged.candidates[place]);
        size_variation(judged, place, &reduced, discount)
    };
    Ok((0..judged.linearised_at.len()).map(one).collect())
}

/// Prior of the coefficients after all trials, whose change has been fitted.
fn prior_after_trials(fixed: &CoefficientPrior, judged: &JudgedHypothesis) -> CoefficientPrior {
    let size = fixed.weighted_mean.len();
    let total = GramMatrix::sum_parts(
        &judged.grams,
        judged.grams.first().map_or(0, |gram| gram.products.nrows()),
    );
    let information = total.products.view((1, 1), (size, size)) + &fixed.information;
    CoefficientPrior { weighted_mean: &information * &judged.shift, information }
}

/// Improvement by separate sizes in the pieces, beyond the common size and beyond chance, relative
/// to the response to the common size.
fn size_variation(
    judged: &JudgedHypothesis,
    place: usize,
    pieces: &[MarginalInformation],
    discount: f64,
) -> f64 {
    let first: usize =
        judged.linearised_at[..place].iter().map(|candidate| candidate.at.len()).sum();
    let own = first..first + judged.linearised_at[place].at.len();
    let moved = DVector::from_vec(judged.parameter_changes());
    let fixing: Vec<NormalPrior> = candidate_priors(&judged.linearised_at[place]);
    let change = DVector::from_vec(judged.candidates[place].parameter_changes());
    let (mut asked, mut chance, mut response) = (0.0, 0.0, 0.0);
    for piece in pieces {
        // The gradient that the common estimate leaves in this piece, and the information on its
        // own size.
        let left =
            (&piece.right - &piece.information * &moved).rows(own.start, own.len()).into_owned();
        let information =
            piece.information.view((own.start, own.start), (own.len(), own.len())).into_owned();
        let prior = DMatrix::from_diagonal(&DVector::from_iterator(
            own.len(),
            fixing.iter().map(|f| f.deviation.powi(-2)),
        ));
        // A piece whose information is not positive is skipped.
        let Some(factor) = Cholesky::new(&information + prior) else { continue };
        asked += left.dot(&factor.solve(&left));
        chance += factor.solve(&information).trace();
        response += change.dot(&(&information * &change));
    }
    (asked - discount * chance) / response.max(THRESHOLDS.constancy.least_response)
}
