//! Information of trials on the coefficients, with some trials held out.

use std::ops::Range;

use nalgebra::Cholesky;
use rayon::prelude::*;

use super::super::coefficient_prior::CoefficientPrior;
use sistership_filtering::GramMatrix;

/// Information on the coefficients, trial by trial.
pub(super) struct TrialInformation<'a> {
    pub fixed: &'a CoefficientPrior,
    pub grams: &'a [GramMatrix],
    /// Factor by which coefficients differ more from trial to trial than the information of each
    /// trial implies (a variance ratio).
    pub scatter: f64,
}

impl TrialInformation<'_> {
    /// Information of the prior and all trials.
    pub fn total_information(&self) -> CoefficientPrior {
        self.add_trials(self.fixed.clone(), 0..self.grams.len())
    }

    /// Information of the prior and all trials but one, for each of them; of a single trial, the
    /// prior. Trials are added in their order, those before one only once for all that follow.
    pub fn leave_one_out(&self) -> Vec<CoefficientPrior> {
        let count = self.grams.len();
        // Prefix sums: the information of the prior and all trials before each one.
        let mut before = vec![self.fixed.clone()];
        for trial in 1..count {
            before.push(self.add_trials(before[trial - 1].clone(), trial - 1..trial));
        }
        before.truncate(count);
        let others = before.into_par_iter().enumerate();
        others.map(|(trial, before)| self.add_trials(before, trial + 1..count)).collect()
    }

    /// Adds the information of some trials to a prior.
    fn add_trials(&self, mut known: CoefficientPrior, trials: Range<usize>) -> CoefficientPrior {
        let size = known.weighted_mean.len();
        // In place: as expressions these would be two new matrices a trial.
        for gram in &self.grams[trials] {
            // The residual is at index 0, so that coefficients begin at 1.
            let products = gram.products.view((1, 0), (size, size + 1));
            let add = |sum: &mut f64, product: f64| *sum += product / self.scatter;
            known.information.zip_apply(&products.columns(1, size), add);
            known.weighted_mean.zip_apply(&products.column(0), add);
        }
        known
    }

    /// Ratio of the residual that a trial's own coefficients explain, after a fit on the others, to
    /// that expected by chance: one where the law is right, more where the information is
    /// overconfident.
    pub fn variance_ratio(&self) -> f64 {
        let own =
            |(gram, others): (&GramMatrix, CoefficientPrior)| explained_by_trial(gram, &others);
        let each: Vec<Option<(f64, f64)>> =
            self.grams.par_iter().zip(self.leave_one_out()).map(own).collect();
        // Summed in order: the same on any number of threads.
        let sum =
            each.into_iter().flatten().fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
        // Never below one: trials that agree by chance add no information.
        if sum.1 > 0.0 { (sum.0 / sum.1).max(1.0) } else { 1.0 }
    }
}

/// Residual of a trial that its own coefficients would explain after a fit on the others, and the
/// part expected by chance.
fn explained_by_trial(gram: &GramMatrix, others: &CoefficientPrior) -> Option<(f64, f64)> {
    let size = others.weighted_mean.len();
    let mean = others.expected_change()?;
    let products = gram.products.view((1, 1), (size, size));
    // The gradient left by the others' mean, b - A m, and the improvement g' (A + L)^-1 g with the
    // prior L.
    let left = gram.products.view((1, 0), (size, 1)).column(0) - products * mean;
    let factor = Cholesky::new(products + &others.information)?;
    Some((left.dot(&factor.solve(&left)), factor.solve(&products.into_owned()).trace()))
}

/// Change of the coefficients by an information; all effects absent.
pub(super) fn expected_columns(known: &CoefficientPrior, width: usize) -> Option<Vec<f64>> {
    let mut shift = known.expected_change()?.as_slice().to_vec();
    shift.resize(width, 0.0);
    Some(shift)
}
