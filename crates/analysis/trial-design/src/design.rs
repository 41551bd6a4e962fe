//! Designs: sets of candidates, and what they leave of the targets.

use nalgebra::{Cholesky, DMatrix};

/// What each candidate tells and takes, and what is to be narrowed.
pub(crate) struct Design {
    /// Information of each candidate on the deviations.
    pub information: Vec<DMatrix<f64>>,
    /// How long each takes, s.
    pub takes_s: Vec<f64>,
    /// Targets by deviations.
    pub gradients: DMatrix<f64>,
    /// Information before any of them: the posterior's, with that of trials sailed since.
    pub before: DMatrix<f64>,
}

impl Design {
    /// Information with some candidates, each as often as it stands there.
    pub fn with(&self, chosen: &[usize]) -> DMatrix<f64> {
        chosen.iter().fold(self.before.clone(), |sum, &place| sum + &self.information[place])
    }

    /// Standard deviations of the targets under information on the deviations; none where that is
    /// not positive.
    pub fn deviations(&self, information: DMatrix<f64>) -> Option<Vec<f64>> {
        let lower = Cholesky::new(information)?.unpack();
        let scaled = lower.solve_lower_triangular(&self.gradients.transpose())?;
        Some(scaled.column_iter().map(|column| column.norm()).collect())
    }

    /// The mean logarithm of the targets' deviations; infinite where nothing can be said.
    pub fn score(&self, information: DMatrix<f64>) -> f64 {
        let Some(deviations) = self.deviations(information) else { return f64::INFINITY };
        deviations.iter().map(|d| d.ln()).sum::<f64>() / deviations.len() as f64
    }

    /// How long some candidates take, s.
    pub fn lasts_s(&self, chosen: &[usize]) -> f64 {
        chosen.iter().map(|&place| self.takes_s[place]).sum()
    }

    /// By what share the bands are narrower in the (geometric) mean with some candidates.
    pub fn narrower(&self, chosen: &[usize]) -> f64 {
        1.0 - (self.score(self.with(chosen)) - self.score(self.before.clone())).exp()
    }
}
