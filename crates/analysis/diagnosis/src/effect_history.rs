//! Information of earlier trials on the effects of a ship: diagnoses in sequence.
//!
//! Each diagnosis adds the information of its trials on the parameters of all forms, at the absence
//! of every effect and with the coefficients integrated out. It is that of one more trial for the
//! next diagnosis, so that many small uploads say as much as one large one, and its size does not
//! grow. An effect may begin at any time: where the newest trials alone are at least as evident as
//! all since an earlier start, its columns are zero on the earlier ones (Page 1954, Biometrika 41,
//! 100-115), or, if these show it, as before a repair, it is integrated out.

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_filtering::{EffectCandidate, GramMatrix};

use super::evidence::MarginalInformation;

/// Information of earlier trials on the effects of a ship, in the order of the forms.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectHistory {
    /// Name of the model that was diagnosed.
    pub model: String,
    /// Forms of effects.
    pub forms: Vec<FormHistory>,
    /// Information on the parameters of all forms: lower triangle, row by row.
    pub information: Vec<f64>,
    /// Information times the most probable distances of the parameters from the absence.
    pub right: Vec<f64>,
    /// Hashes of the samples of all earlier trials, by which one that is given again is recognised.
    #[serde(default)]
    pub samples: Vec<String>,
}

/// Earlier trials that count for a form of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FormHistory {
    /// `effect/form`.
    pub key: String,
    /// Number of parameters.
    pub parameters: usize,
    /// Number of trials since the effect may have begun.
    pub trials: usize,
    /// First of these trials.
    pub since: String,
    /// Last trial of the newest diagnosis that named the effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last_seen: Option<String>,
}

impl EffectHistory {
    /// Checks that the numbers are those of the forms.
    ///
    /// # Errors
    /// Returns the reason for which they are not.
    pub fn check_values(&self) -> Result<(), String> {
        // An answer may have been edited or cut: numbers that do not fit the forms would be read as
        // those of others.
        let size = self.forms.iter().map(|form| form.parameters).sum::<usize>();
        let is_complete =
            self.right.len() == size && self.information.len() == size * (size + 1) / 2;
        if !is_complete {
            return Err(format!("must have {size} parameters with their information"));
        }
        let all = self.information.iter().chain(&self.right);
        match all.copied().all(f64::is_finite) {
            true => Ok(()),
            false => Err("must have finite numbers only".to_owned()),
        }
    }

    /// Number of earlier trials that count for a form.
    pub fn trial_count(&self, candidate: &EffectCandidate) -> usize {
        let key = candidate.candidate_key();
        self.forms.iter().find(|form| form.key == key).map_or(0, |form| form.trials)
    }

    /// Returns the products of the earlier trials on the columns of candidates at their values,
    /// after those of the coefficients, on which they have no information of their own.
    pub fn trial_products(
        &self,
        coefficients: usize,
        candidates: &[EffectCandidate],
    ) -> GramMatrix {
        let (information, right) = self.candidate_information(candidates);
        let size = right.len();
        let moved = DVector::from_iterator(
            size,
            candidates.iter().flat_map(EffectCandidate::parameter_changes),
        );
        // Minus twice the logarithm of the likelihood about the values, relative to the absence.
        let slope = &information * &moved;
        let left = &right - &slope;
        // The coefficients were integrated out when the trials were read, so that their rows stay zero.
        let mut gram = GramMatrix::zeros(1 + coefficients + size);
        gram.products[(0, 0)] = moved.dot(&slope) - 2.0 * right.dot(&moved);
        for i in 0..size {
            let place = 1 + coefficients + i;
            (gram.products[(0, place)], gram.products[(place, 0)]) = (left[i], left[i]);
            (0..size).for_each(|j| {
                gram.products[(place, 1 + coefficients + j)] = information[(i, j)];
            });
        }
        gram
    }

    /// Adds the earlier trials to the information of others on the columns of candidates.
    pub fn add_to(&self, says: &mut MarginalInformation, candidates: &[EffectCandidate]) {
        // Information adds up, since the noise of different trials is independent.
        let gram = self.trial_products(0, candidates).products;
        let size = gram.nrows() - 1;
        says.information += gram.view((1, 1), (size, size));
        says.right += gram.view((1, 0), (size, 1)).column(0);
    }

    /// Replaces the information on the parameters of candidates.
    pub(super) fn set_information(
        &mut self,
        candidates: &[EffectCandidate],
        says: &MarginalInformation,
    ) {
        let places: Vec<Option<usize>> =
            candidates.iter().flat_map(|candidate| self.parameter_places(candidate)).collect();
        for (i, own) in places.iter().enumerate() {
            let Some(own) = *own else { continue };
            self.right[own] = says.right[i];
            for (j, other) in places.iter().enumerate().filter_map(|(j, one)| Some((j, (*one)?))) {
                self.information[triangle_place(own, other)] = says.information[(i, j)];
            }
        }
    }

    /// Counts no earlier trial for a form.
    pub(super) fn forget_trials(&mut self, candidate: &EffectCandidate) {
        let key = candidate.candidate_key();
        self.forms.iter_mut().filter(|form| form.key == key).for_each(|form| form.trials = 0);
    }

    /// Information on the parameters of candidates, and its product with their most probable
    /// distances from the absence; zero for forms without a history.
    pub(super) fn candidate_information(
        &self,
        candidates: &[EffectCandidate],
    ) -> (DMatrix<f64>, DVector<f64>) {
        let places: Vec<Option<usize>> =
            candidates.iter().flat_map(|candidate| self.parameter_places(candidate)).collect();
        let size = places.len();
        let information = DMatrix::from_fn(size, size, |i, j| {
            places[i].zip(places[j]).map_or(0.0, |(i, j)| self.information[triangle_place(i, j)])
        });
        let right = |i: usize| places[i].map_or(0.0, |place| self.right[place]);
        (information, DVector::from_fn(size, |i, _| right(i)))
    }

    /// Places of the parameters of a candidate.
    fn parameter_places(&self, candidate: &EffectCandidate) -> Vec<Option<usize>> {
        let key = candidate.candidate_key();
        let mut first = 0;
        for form in &self.forms {
            // A form of the same name with other parameters is of another library.
            if form.key == key && form.parameters == candidate.at.len() {
                return (first..first + form.parameters).map(Some).collect();
            }
            first += form.parameters;
        }
        vec![None; candidate.at.len()]
    }
}

/// Place in a lower triangle that is stored row by row.
fn triangle_place(i: usize, j: usize) -> usize {
    let (row, column) = (i.max(j), i.min(j));
    row * (row + 1) / 2 + column
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use sistership_model::Zoo;

    use super::*;

    fn offset(at: f64) -> EffectCandidate {
        let zoo = Zoo::load_embedded().unwrap();
        let effect = Arc::clone(zoo.effect("rudder-offset").unwrap());
        let absent = EffectCandidate::at_absence(&effect.name, &effect.forms[0]);
        EffectCandidate { at: vec![at], ..absent }
    }

    fn history() -> EffectHistory {
        let form = FormHistory {
            key: offset(0.0).candidate_key(),
            parameters: 1,
            trials: 4,
            since: "first".into(),
            last_seen: None,
        };
        let model = "a model".to_owned();
        EffectHistory {
            model,
            forms: vec![form],
            information: vec![100.0],
            right: vec![2.0],
            samples: Vec::new(),
        }
    }

    /// Likelihood of an offset `d` by the information `A` and the right side `b`: `b d - A d^2/2`,
    /// whatever the value about which it is expanded.
    #[test]
    fn earlier_trials_are_one_more_trial() {
        for at in [0.0, 0.03] {
            let gram = history().trial_products(2, &[offset(at)]);
            assert_eq!(gram.products.nrows(), 4);
            for d in [0.0, 0.02, 0.05] {
                let from = d - at;
                let minus_twice = gram.products[(0, 0)] - 2.0 * gram.products[(0, 3)] * from
                    + gram.products[(3, 3)] * from * from;
                assert!((minus_twice + 2.0 * (2.0 * d - 50.0 * d * d)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_history_without_a_form_says_nothing_of_it() {
        let gram = EffectHistory::default().trial_products(1, &[offset(0.02)]);
        assert!(gram.products.iter().all(|value| *value == 0.0));
        let incomplete = EffectHistory { right: Vec::new(), ..history() };
        assert!(incomplete.check_values().is_err() && history().check_values().is_ok());
    }
}
