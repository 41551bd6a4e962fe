//! Groups of axes with common regressors and a common shape of their prior: one path of solutions
//! for all of them.

use nalgebra::DMatrix;
use sistership_model::coefficient::Axis;

use super::prior::BulkPrior;
use crate::statistics::{RegressionStatistics, TrialStatistics};
use sistership_identification::refine::{FittedCoefficient, RefineError};
use sistership_numerics::{RegressionMoments, WhitenedPath};

/// Coefficients of some axes, in coordinates in which their prior is white, about its mean.
pub(super) struct AxisGroup {
    pub axes: Vec<Axis>,
    /// Names of the coefficients, by axis.
    pub names: Vec<Vec<String>>,
    /// Mean of the prior, by axis.
    pub means: Vec<Vec<f64>>,
    /// Root of the prior's covariance at strength 1.
    pub root: DMatrix<f64>,
    /// Statistics of each trial in these coordinates.
    pub parts: Vec<RegressionMoments>,
    /// Decomposed statistics of all trials.
    pub whole: WhitenedPath,
    /// For each trial, the statistics of all others.
    pub without: Vec<RegressionMoments>,
}

impl AxisGroup {
    /// Lambda of strength 1. For a family's prior it is the residual variance divided by the number
    /// of samples, times the design effect, at which the prior has the covariance that was learned;
    /// for a source it is 1.
    pub fn unit_lambda(&self, prior: BulkPrior<'_>) -> f64 {
        let all = &self.whole;
        match prior {
            BulkPrior::Source(_) => 1.0,
            BulkPrior::Family { design_effect, .. } => {
                design_effect * all.residual_variance(0, all.least_lambda()) / all.sample_count()
            }
        }
    }

    /// Errors on each trial by the solutions of the others, by fold, axis and strength; a single
    /// trial is evaluated on itself.
    pub fn held_out_errors(&self, lambdas: &[f64]) -> Vec<Vec<Vec<f64>>> {
        if self.parts.len() == 1 {
            return vec![self.whole.held_out_errors(lambdas, &self.parts[0])];
        }
        let others = self.without.iter().map(WhitenedPath::new);
        others
            .zip(&self.parts)
            .map(|(others, part)| others.held_out_errors(lambdas, part))
            .collect()
    }

    /// Coefficients of an axis at a lambda; those of the prior if it is `None`.
    pub fn fit_axis(
        &self,
        axis: usize,
        directions: &DMatrix<f64>,
        lambda: Option<f64>,
        strongest: f64,
    ) -> Vec<FittedCoefficient> {
        let at = lambda.unwrap_or(strongest);
        let scatter = self.whole.residual_variance(axis, at);
        // Without a lambda the coefficients stay at the prior's mean, and the strongest prior gives
        // the errors.
        let step = lambda.map(|lambda| directions * self.whole.eigenbasis_solution(axis, lambda));
        let variances = self.whole.posterior_variances(at);
        // Standard deviation of the prior in its white coordinates.
        let held = (scatter / (self.whole.sample_count() * at)).sqrt();
        let one = |(j, mean): (usize, &f64)| {
            let posterior: f64 =
                // Diagonal of directions diag(variances) directions'.
                directions.row(j).iter().zip(variances.iter()).map(|(v, w)| v * v * w).sum();
            FittedCoefficient {
                value: mean + step.as_ref().map_or(0.0, |step| step[j]),
                standard_error: (scatter * posterior).sqrt(),
                prior_deviation: held * self.root.row(j).norm(),
            }
        };
        self.means[axis].iter().enumerate().map(one).collect()
    }
}

/// Groups of a ship: one for each regression under a source's prior, where one root serves all
/// axes, otherwise one for each axis.
pub(super) fn axis_groups(
    trials: &[TrialStatistics],
    prior: BulkPrior<'_>,
) -> Result<Vec<AxisGroup>, RefineError> {
    // All trials must be of one frame, or their statistics could not be added.
    let first = trials
        .first()
        .ok_or_else(|| RefineError::Data("there is no trial to fit to; upload trials".into()))?;
    if let Some(other) = trials.iter().find(|trial| !first.has_same_frame(trial)) {
        let count = other.regressions.len();
        return Err(RefineError::Data(format!(
            "the statistics of two trials ({count} regressions) were computed for different models"
        )));
    }
    let mut groups = Vec::new();
    for (index, regression) in first.regressions.iter().enumerate() {
        let parts: Vec<&RegressionMoments> =
            trials.iter().map(|trial| &trial.regressions[index].moments).collect();
        match prior {
            BulkPrior::Source(_) => {
                groups.push(build_group(regression, 0..regression.axes.len(), &parts, prior)?)
            }
            BulkPrior::Family { .. } => {
                // A family's covariance differs between the axes, so each needs coordinates of its
                // own.
                for axis in 0..regression.axes.len() {
                    groups.push(build_group(regression, axis..axis + 1, &parts, prior)?);
                }
            }
        }
    }
    Ok(groups)
}

/// Group of some axes of a regression, in the coordinates of the prior.
fn build_group(
    regression: &RegressionStatistics,
    axes: std::ops::Range<usize>,
    parts: &[&RegressionMoments],
    prior: BulkPrior<'_>,
) -> Result<AxisGroup, RefineError> {
    let names = regression.names[axes.clone()].to_vec();
    let unknown = || {
        RefineError::Data(format!("the prior lacks the coefficients {}", names.concat().join(", ")))
    };
    let means: Vec<Vec<f64>> = names
        .iter()
        .map(|names| prior.prior_means(names))
        .collect::<Option<_>>()
        .ok_or_else(unknown)?;
    let root = match prior.axis_prior(&names[0]) {
        Some(axis) => axis.root.clone(),
        None => DMatrix::from_diagonal(&inverse_deviations(regression, parts)?.into()),
    };
    let map = coordinate_map(&root, &means, &regression.unmixing_matrix()?, axes.start);
    let mut parts: Vec<RegressionMoments> =
        parts.iter().map(|part| part.map_linear(&map, root.ncols())).collect();
    if matches!(prior, BulkPrior::Family { .. }) {
        // The same as in learning the family: a model has no intercept, and a nearly constant
        // regressor must not be determined by its small changes alone.
        parts.iter_mut().for_each(|part| *part = part.about_origin());
    }
    let (without, all) = RegressionMoments::leave_one_out(&parts).ok_or_else(unknown)?;
    Ok(AxisGroup {
        axes: regression.axes[axes].to_vec(),
        names,
        means,
        root,
        parts,
        whole: WhitenedPath::new(&all),
        without,
    })
}

/// Map from stored regressors and targets to those of the group: regressors times the root; targets
/// of each axis less the prediction of the prior's mean.
fn coordinate_map(
    root: &DMatrix<f64>,
    means: &[Vec<f64>],
    unmixing: &DMatrix<f64>,
    first: usize,
) -> DMatrix<f64> {
    let (p, kept) = (root.nrows(), unmixing.nrows());
    let mut map = DMatrix::zeros(p + kept, p + means.len());
    map.view_mut((0, 0), (p, p)).copy_from(root);
    for (axis, mean) in means.iter().enumerate() {
        // Target less the prediction of the mean: t_axis = unmixing targets - mean' regressors.
        (0..p).for_each(|j| map[(j, p + axis)] = -mean[j]);
        (0..kept).for_each(|target| map[(p + target, p + axis)] = unmixing[(first + axis, target)]);
    }
    map
}

/// Prior deviation of each coefficient at strength 1: the inverse of its regressor's standard
/// deviation, divided by the root of its shrinkage; zero if the regressor does not vary.
fn inverse_deviations(
    regression: &RegressionStatistics,
    parts: &[&RegressionMoments],
) -> Result<Vec<f64>, RefineError> {
    let all = RegressionMoments::merge_all(parts.iter().copied()).filter(|all| all.count > 0.0);
    let all =
        all.ok_or_else(|| RefineError::Data("the trials have no samples that can be used".into()))?;
    let one = |(j, shrinkage): (usize, &f64)| {
        let deviation = all.regressor_variance(j).sqrt();
        // Relative to the mean: rounding leaves a small deviation to a constant.
        let varies = deviation / all.regressor_mean(j).abs().max(1e-300) > 1e-10;
        if varies { 1.0 / (deviation * shrinkage.sqrt()) } else { 0.0 }
    };
    Ok(regression.shrinkage.iter().enumerate().map(one).collect())
}
