//! Evidence of a member's trials on the coefficients of an axis: a precision and an information
//! vector, in units in which coefficients have similar sizes.

use nalgebra::{DMatrix, DVector};

use super::thresholds::FAMILY;
use crate::statistics::TrialStatistics;
use sistership_identification::refine::RefineError;
use sistership_numerics::{RegressionMoments, WhitenedPath};

/// Likelihood of trials, proportional to `exp(-z' precision z/2 + information' z)`.
#[derive(Debug, Clone)]
pub(super) struct MemberEvidence {
    pub precision: DMatrix<f64>,
    pub information: DVector<f64>,
    /// Ratio of the scatter between the member's trials to that expected of independent samples;
    /// `None` for one trial.
    pub design_effect: Option<f64>,
}

/// Axis of a family: index of its coefficients in the statistics, and their units.
#[derive(Debug, Clone)]
pub(super) struct AxisIndex {
    pub regression: usize,
    pub axis: usize,
    pub units: Vec<f64>,
}

impl AxisIndex {
    /// Statistics of each trial: regressors in units of the coefficients, and the axis' own target.
    fn axis_moments(
        &self,
        trials: &[TrialStatistics],
    ) -> Result<Vec<RegressionMoments>, RefineError> {
        let Some(first) = trials.first() else { return Ok(Vec::new()) };
        let regression = &first.regressions[self.regression];
        let (p, q) = (self.units.len(), regression.axes.len());
        let unmixing = regression.unmixing_matrix()?;
        let mut map = DMatrix::zeros(p + q, p + 1);
        (0..p).for_each(|j| map[(j, j)] = self.units[j]);
        (0..q).for_each(|target| map[(p + target, p)] = unmixing[(self.axis, target)]);
        let own = |trial: &TrialStatistics| {
            // About the origin, as the model has no intercept.
            trial.regressions[self.regression].moments.map_linear(&map, p).about_origin()
        };
        Ok(trials.iter().map(own).collect())
    }

    /// Evidence of a member's trials; `None` if they have no sample.
    ///
    /// # Errors
    /// Returns an error if their axes cannot be distinguished.
    pub fn member_evidence(
        &self,
        trials: &[TrialStatistics],
    ) -> Result<Option<MemberEvidence>, RefineError> {
        let parts = self.axis_moments(trials)?;
        let Some(all) = RegressionMoments::merge_all(&parts).filter(|all| all.count > 0.0) else {
            return Ok(None);
        };
        let whitened = WhitenedPath::new(&all);
        let lambda = whitened.least_lambda();
        let variance = whitened.residual_variance(0, lambda).max(f64::MIN_POSITIVE);
        let (covariance, cross) = all.covariance_blocks();
        // The precision of n samples with this residual variance is n / variance times their
        // covariance.
        let share = all.count / variance;
        // Least squares solution, except in directions that the samples do not determine.
        let least = whitened.eigenvector_basis() * whitened.eigenbasis_solution(0, lambda);
        let design_effect =
            (parts.len() > 1).then(|| score_scatter(&parts, &all, &whitened, &least) / variance);
        Ok(Some(MemberEvidence {
            precision: covariance * share,
            information: cross.column(0) * share,
            design_effect,
        }))
    }
}

/// Residual variance implied by the scatter of the trials' scores (a sandwich estimate with whole
/// trials as its units: Liang and Zeger 1986, Biometrika 73, 13-22, Eq. 8), averaged over the
/// directions that the trials determine.
fn score_scatter(
    parts: &[RegressionMoments],
    all: &RegressionMoments,
    whitened: &WhitenedPath,
    least: &DVector<f64>,
) -> f64 {
    let variances = whitened.posterior_variances(0.0);
    let best = variances.min();
    // Directions that the trials do not determine would only add rounding errors.
    let told: Vec<usize> =
        (0..variances.len()).filter(|&k| best / variances[k] > FAMILY.telling).collect();
    let of_trial = |part: &RegressionMoments| -> f64 {
        let score = whitened.eigenvector_basis().transpose() * part.residual_score(all, least);
        told.iter().map(|&k| score[k].powi(2) * variances[k]).sum()
    };
    let trials = parts.len() as f64;
    // Mean over directions, with the correction n / (n - 1) for the number of trials.
    parts.iter().map(of_trial).sum::<f64>() / (told.len().max(1) as f64 * (1.0 - 1.0 / trials))
}
