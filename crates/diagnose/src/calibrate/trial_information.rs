//! What trials say of the coefficients, some of them left out.

use nalgebra::Cholesky;
use rayon::prelude::*;

use super::super::coefficient_prior::CoefficientPrior;
use crate::residual::Gram;

/// What is known of the coefficients, trial by trial.
pub(super) struct TrialInformation<'a> {
    pub fixed: &'a CoefficientPrior,
    pub grams: &'a [Gram],
    /// How much more coefficients differ from trial to trial than each trial by itself would say.
    pub scatter: f64,
}

impl TrialInformation<'_> {
    /// By the prior and some of the trials.
    pub fn by(&self, keep: &dyn Fn(usize) -> bool) -> CoefficientPrior {
        let mut known = self.fixed.clone();
        let size = known.weighted_mean.len();
        // In place: as expressions these would be two new matrices a trial.
        for (_, gram) in self.grams.iter().enumerate().filter(|(trial, _)| keep(*trial)) {
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
        let each: Vec<Option<(f64, f64)>> =
            (0..self.grams.len()).into_par_iter().map(|trial| self.own(trial)).collect();
        // Summed in order: the same on any number of threads.
        let sum =
            each.into_iter().flatten().fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
        if sum.1 > 0.0 { (sum.0 / sum.1).max(1.0) } else { 1.0 }
    }

    /// What a trial would explain of what the others leave of it, and what chance would.
    fn own(&self, trial: usize) -> Option<(f64, f64)> {
        let size = self.fixed.weighted_mean.len();
        let others = self.by(&|other| other != trial);
        let (mean, gram) = (others.mean()?, &self.grams[trial]);
        let products = gram.products.view((1, 1), (size, size));
        let left = gram.products.view((1, 0), (size, 1)).column(0) - products * mean;
        let factor = Cholesky::new(products + &others.information)?;
        Some((left.dot(&factor.solve(&left)), factor.solve(&products.into_owned()).trace()))
    }

    /// The change of the coefficients by the trials but one; all effects absent.
    pub fn shift(&self, but: usize, width: usize) -> Option<Vec<f64>> {
        let known = self.by(&|trial| trial != but);
        let mut shift = known.mean()?.as_slice().to_vec();
        shift.resize(width, 0.0);
        Some(shift)
    }
}
