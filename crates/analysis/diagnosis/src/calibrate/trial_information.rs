//! What trials say of the coefficients, some of them left out.

use std::ops::Range;

use nalgebra::Cholesky;
use rayon::prelude::*;

use super::super::coefficient_prior::CoefficientPrior;
use sistership_filtering::Gram;

/// What is known of the coefficients, trial by trial.
pub(super) struct TrialInformation<'a> {
    pub fixed: &'a CoefficientPrior,
    pub grams: &'a [Gram],
    /// How much more coefficients differ from trial to trial than each trial by itself would say.
    pub scatter: f64,
}

impl TrialInformation<'_> {
    /// By the prior and all trials.
    pub fn all(&self) -> CoefficientPrior {
        self.with(self.fixed.clone(), 0..self.grams.len())
    }

    /// By the prior and all trials but one, for each of them; of a single trial, the prior. Trials
    /// are added in their order, those before one once for all that come after.
    pub fn but_one(&self) -> Vec<CoefficientPrior> {
        let count = self.grams.len();
        let mut before = vec![self.fixed.clone()];
        for trial in 1..count {
            before.push(self.with(before[trial - 1].clone(), trial - 1..trial));
        }
        before.truncate(count);
        let others = before.into_par_iter().enumerate();
        others.map(|(trial, before)| self.with(before, trial + 1..count)).collect()
    }

    /// What is known, and what some trials say.
    fn with(&self, mut known: CoefficientPrior, trials: Range<usize>) -> CoefficientPrior {
        let size = known.weighted_mean.len();
        // In place: as expressions these would be two new matrices a trial.
        for gram in &self.grams[trials] {
            let products = gram.products.view((1, 0), (size, size + 1));
            let add = |sum: &mut f64, product: f64| *sum += product / self.scatter;
            known.information.zip_apply(&products.columns(1, size), add);
            known.weighted_mean.zip_apply(&products.column(0), add);
        }
        known
    }

    /// What coefficients fitted on the others leave of each trial and its own would explain, by
    /// what chance would: one where the law is right, more where it only seems to be known so well.
    pub fn scatter(&self) -> f64 {
        let own = |(gram, others): (&Gram, CoefficientPrior)| own(gram, &others);
        let each: Vec<Option<(f64, f64)>> =
            self.grams.par_iter().zip(self.but_one()).map(own).collect();
        // Summed in order: the same on any number of threads.
        let sum =
            each.into_iter().flatten().fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
        if sum.1 > 0.0 { (sum.0 / sum.1).max(1.0) } else { 1.0 }
    }
}

/// What a trial would explain of what the others leave of it, and what chance would.
fn own(gram: &Gram, others: &CoefficientPrior) -> Option<(f64, f64)> {
    let size = others.weighted_mean.len();
    let mean = others.mean()?;
    let products = gram.products.view((1, 1), (size, size));
    let left = gram.products.view((1, 0), (size, 1)).column(0) - products * mean;
    let factor = Cholesky::new(products + &others.information)?;
    Some((left.dot(&factor.solve(&left)), factor.solve(&products.into_owned()).trace()))
}

/// The change of the coefficients by what is known of them; all effects absent.
pub(super) fn shift(known: &CoefficientPrior, width: usize) -> Option<Vec<f64>> {
    let mut shift = known.mean()?.as_slice().to_vec();
    shift.resize(width, 0.0);
    Some(shift)
}
