//! What a model leaves of a trial, from its statistics.

use std::collections::BTreeMap;

use nalgebra::DVector;
use sistership_model::coefficient::Axis;

use super::{Regression, TrialStatistics};
use sistership_estimate::refine::RefineError;

/// What the coefficients of an axis leave of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Left {
    /// The axis.
    pub axis: Axis,
    /// Mean square of what they leave, in the units of the axis' targets.
    pub residual: f64,
    /// Mean square of the target itself.
    pub target: f64,
}

impl TrialStatistics {
    /// What coefficients leave of each axis; those that are not named count as zero.
    ///
    /// # Errors
    /// The statistics mix axes that cannot be told apart.
    pub fn left_by(&self, coefficients: &BTreeMap<String, f64>) -> Result<Vec<Left>, RefineError> {
        let mut all = Vec::new();
        for regression in &self.regressions {
            all.extend(regression.left_by(coefficients)?);
        }
        Ok(all)
    }
}

impl Regression {
    fn left_by(&self, coefficients: &BTreeMap<String, f64>) -> Result<Vec<Left>, RefineError> {
        let (raw, unmixing) = (self.moments.raw_products(), self.unmixing()?);
        let p = self.moments.regressors();
        let mean_square = |weights: &DVector<f64>| weights.dot(&(&raw * weights)).max(0.0);
        let one = |(index, &axis): (usize, &Axis)| {
            let mut weights = DVector::zeros(raw.nrows());
            (0..self.axes.len()).for_each(|target| weights[p + target] = unmixing[(index, target)]);
            let target = mean_square(&weights);
            let values = self.names[index].iter().map(|name| coefficients.get(name).copied().unwrap_or(0.0));
            values.enumerate().for_each(|(j, value)| weights[j] = -value);
            Left { axis, residual: mean_square(&weights), target }
        };
        Ok(self.axes.iter().enumerate().map(one).collect())
    }
}
