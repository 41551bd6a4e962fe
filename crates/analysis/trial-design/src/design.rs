//! Designs: sets of candidates, and the uncertainty of the targets after them.

use nalgebra::{Cholesky, DMatrix};

/// Information and duration of each candidate, and the targets of the design.
pub(crate) struct TrialDesign {
    /// Information of each candidate on the deviations.
    pub information: Vec<DMatrix<f64>>,
    /// Duration of each candidate, s.
    pub takes_s: Vec<f64>,
    /// Gradients: targets by deviations.
    pub gradients: DMatrix<f64>,
    /// Information before any of them: the posterior's, with that of trials recorded since.
    pub before: DMatrix<f64>,
}

impl TrialDesign {
    /// Information with some candidates, each as often as it occurs.
    pub fn information_with(&self, chosen: &[usize]) -> DMatrix<f64> {
        chosen.iter().fold(self.before.clone(), |sum, &place| sum + &self.information[place])
    }

    /// Standard deviations of the targets under information on the deviations; none where that is
    /// not positive.
    pub fn target_deviations(&self, information: DMatrix<f64>) -> Option<Vec<f64>> {
        // With the Cholesky factor L of the information: the variance g' (L L')^-1 g is |L^-1 g|^2.
        let lower = Cholesky::new(information)?.unpack();
        let scaled = lower.solve_lower_triangular(&self.gradients.transpose())?;
        Some(scaled.column_iter().map(|column| column.norm()).collect())
    }

    /// Mean logarithm of the targets' deviations; infinite where the information is not positive.
    pub fn log_mean_deviation(&self, information: DMatrix<f64>) -> f64 {
        let Some(deviations) = self.target_deviations(information) else { return f64::INFINITY };
        // A mean of logarithms: units cancel in differences, so that metres and degrees need no
        // weights.
        deviations.iter().map(|d| d.ln()).sum::<f64>() / deviations.len() as f64
    }

    /// Duration of some candidates, s.
    pub fn lasts_s(&self, chosen: &[usize]) -> f64 {
        chosen.iter().map(|&place| self.takes_s[place]).sum()
    }

    /// Share by which the bands are narrower in the geometric mean with some candidates.
    pub fn relative_narrowing(&self, chosen: &[usize]) -> f64 {
        1.0 - (self.log_mean_deviation(self.information_with(chosen))
            - self.log_mean_deviation(self.before.clone()))
        .exp()
    }
}
