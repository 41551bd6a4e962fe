//! Uncertainty of an effect's parameters: by noise and slack, and by errors that no trial can
//! reduce.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::coefficient_prior::CoefficientPrior;
use super::hypothesis::{JudgedHypothesis, candidate_priors};
use super::misfit::size_error;
use super::thresholds::THRESHOLDS;
use super::values::own_covariance;
use sistership_filtering::{GramMatrix, NuisanceColumn, NuisanceKind};

/// Covariance of an effect's parameters, with its false-alarm level on clean trials, the error of
/// its own law, and the uncertainty of the virtual masses. `discount` is the divisor of the
/// information on the effect.
pub(super) fn effect_covariance(
    judged: &JudgedHypothesis,
    place: usize,
    (nuisance, fixed): (&[NuisanceColumn], &CoefficientPrior),
    discount: f64,
) -> DMatrix<f64> {
    let candidate = &judged.candidates[place];
    let own = own_covariance(&judged.candidates, place, &judged.covariance);
    let change = DVector::from_vec(candidate.parameter_changes());
    // Squared response of the effect in standard deviations: the error of its shape grows with it.
    let response =
        Cholesky::new(own.clone()).map_or(0.0, |factor| change.dot(&factor.solve(&change)));
    let size = size_error(candidate);
    let mut covariance = own * (discount + THRESHOLDS.effect.shape.powi(2) * response);
    // An error of size scales all parameters together.
    covariance += &change * change.transpose() * size.powi(2);
    if let Some(answers) = mass_sensitivities(judged, place, nuisance, fixed) {
        covariance += &answers * answers.transpose() * THRESHOLDS.effect.mass_deviation.powi(2);
    }
    covariance
}

/// Derivatives of an effect's parameters with each virtual mass, the coefficients adjusting within
/// their uncertainty: a consider analysis (Schmidt 1966, Adv Control Syst 3, 293-340).
fn mass_sensitivities(
    judged: &JudgedHypothesis,
    place: usize,
    nuisance: &[NuisanceColumn],
    fixed: &CoefficientPrior,
) -> Option<DMatrix<f64>> {
    let is_mass = |column: &usize| {
        matches!(nuisance.get(*column).map(|n| n.kind), Some(NuisanceKind::Mass(..)))
    };
    let size = judged.grams.first()?.products.nrows();
    let total = GramMatrix::sum_parts(&judged.grams, size);
    let (masses, others): (Vec<usize>, Vec<usize>) = (0..size - 1).partition(is_mass);
    let fixing: Vec<f64> = judged
        .linearised_at
        .iter()
        .flat_map(candidate_priors)
        .map(|prior| prior.deviation.powi(-2))
        .collect();
    let known = nuisance.len();
    // Information of data and priors: coefficients first, then the parameters of effects.
    let information = |i: usize, j: usize| {
        let before = if i < known && j < known { fixed.information[(i, j)] } else { 0.0 };
        let prior = if i == j && i >= known { fixing[i - known] } else { 0.0 };
        total.products[(1 + i, 1 + j)] + before + prior
    };
    let own =
        DMatrix::from_fn(others.len(), others.len(), |i, j| information(others[i], others[j]));
    let cross =
        DMatrix::from_fn(others.len(), masses.len(), |i, j| information(others[i], masses[j]));
    let answers = Cholesky::new(own)?.solve(&cross);
    let first: usize =
        judged.linearised_at[..place].iter().map(|candidate| candidate.at.len()).sum();
    let start = others.len() - fixing.len() + first;
    Some(answers.rows(start, judged.linearised_at[place].at.len()).into_owned())
}
