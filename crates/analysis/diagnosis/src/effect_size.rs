//! Effects whose size is zero within its error: their evidence comes from values outside the bounds
//! of their parameters, or from the shape of their form alone.

use nalgebra::{Cholesky, DVector};

use super::hypothesis::JudgedHypothesis;
use super::thresholds::THRESHOLDS;
use super::values::own_covariance;

/// Returns true if the sizes of an effect, without the coefficients of its form, agree with its
/// absence: their squared distance by their covariance is below the square of the least size.
pub(super) fn has_no_size(judged: &JudgedHypothesis, place: usize) -> bool {
    let candidate = &judged.candidates[place];
    let covariance = own_covariance(&judged.candidates, place, &judged.covariance);
    let parameters = candidate.form.parameters.values().enumerate();
    let sizes: Vec<usize> = parameters.filter(|(_, own)| !own.shape).map(|(i, _)| i).collect();
    let changes = candidate.parameter_changes();
    let change = DVector::from_iterator(sizes.len(), sizes.iter().map(|&i| changes[i]));
    let own = covariance.select_rows(&sizes).select_columns(&sizes);
    let square = Cholesky::new(own).map(|factor| change.dot(&factor.solve(&change)));
    let is_small = |square: f64| square < THRESHOLDS.effect.least_size.powi(2);
    !sizes.is_empty() && square.is_some_and(is_small)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use nalgebra::DMatrix;
    use sistership_filtering::EffectCandidate;
    use sistership_model::Zoo;

    use super::*;

    /// A rudder offset of a size, with a standard error of 0.01.
    fn judged(offset: f64) -> JudgedHypothesis {
        let zoo = Zoo::load_embedded().unwrap();
        let effect = Arc::clone(zoo.effect("rudder-offset").unwrap());
        let absent = EffectCandidate::at_absence(&effect.name, &effect.forms[0]);
        let at: Vec<f64> = absent.at.iter().map(|at| at + offset).collect();
        let size = at.len();
        JudgedHypothesis {
            candidates: vec![EffectCandidate { at, ..absent.clone() }],
            log_evidence: 0.0,
            covariance: DMatrix::from_diagonal_element(size, size, 1e-4),
            level: 0,
            shift: DVector::zeros(0),
            grams: Vec::new(),
            linearised_at: vec![absent],
            refusal: None,
        }
    }

    #[test]
    fn an_effect_within_two_standard_errors_of_its_absence_has_no_size() {
        assert!(has_no_size(&judged(0.0), 0) && has_no_size(&judged(0.019), 0));
        assert!(!has_no_size(&judged(0.021), 0));
    }
}
