//! Axes that share regressors and the shape of their prior: one path of solutions for all of them.

use nalgebra::DMatrix;
use sistership_model::coefficient::Axis;

use super::prior::Prior;
use crate::statistics::{Regression, TrialStatistics};
use sistership_identification::refine::{Fitted, RefineError};
use sistership_numerics::{Moments, Whitened};

/// The coefficients of some axes in coordinates where their prior is white, about its mean.
pub(super) struct AxisGroup {
    pub axes: Vec<Axis>,
    /// Names by axis.
    pub names: Vec<Vec<String>>,
    /// The prior's mean by axis.
    pub means: Vec<Vec<f64>>,
    /// A root of the prior's covariance by the strength of the prior.
    pub root: DMatrix<f64>,
    /// The statistics by trial in those coordinates.
    pub parts: Vec<Moments>,
    /// All trials decomposed.
    pub whole: Whitened,
    /// Each trial's others.
    pub without: Vec<Moments>,
}

impl AxisGroup {
    /// The lambda at which the prior is taken at its word: of a family's, where it is the residual
    /// variance by the number of samples; a source has no word but its lambda.
    pub fn unit(&self, prior: Prior<'_>) -> f64 {
        let all = &self.whole;
        match prior {
            Prior::Source(_) => 1.0,
            Prior::Family { design_effect, .. } => {
                design_effect * all.residual_variance(0, all.least_lambda()) / all.count()
            }
        }
    }

    /// Errors on each trial by the solutions of the others, by fold, axis, strength; a single trial
    /// is judged on itself.
    pub fn errors(&self, lambdas: &[f64]) -> Vec<Vec<Vec<f64>>> {
        if self.parts.len() == 1 {
            return vec![self.whole.errors(lambdas, &self.parts[0])];
        }
        let others = self.without.iter().map(Whitened::new);
        others.zip(&self.parts).map(|(others, part)| others.errors(lambdas, part)).collect()
    }

    /// The coefficients of an axis at a lambda; the prior's where there is none.
    pub fn fitted(
        &self,
        axis: usize,
        directions: &DMatrix<f64>,
        lambda: Option<f64>,
        strongest: f64,
    ) -> Vec<Fitted> {
        let at = lambda.unwrap_or(strongest);
        let scatter = self.whole.residual_variance(axis, at);
        let step = lambda.map(|lambda| directions * self.whole.solution(axis, lambda));
        let variances = self.whole.variances(at);
        let held = (scatter / (self.whole.count() * at)).sqrt();
        let one = |(j, mean): (usize, &f64)| {
            let posterior: f64 =
                directions.row(j).iter().zip(variances.iter()).map(|(v, w)| v * v * w).sum();
            Fitted {
                value: mean + step.as_ref().map_or(0.0, |step| step[j]),
                standard_error: (scatter * posterior).sqrt(),
                prior_deviation: held * self.root.row(j).norm(),
            }
        };
        self.means[axis].iter().enumerate().map(one).collect()
    }
}

/// The groups of a ship: those of its regressions where one root serves all axes, else one for each
/// axis.
pub(super) fn groups(
    trials: &[TrialStatistics],
    prior: Prior<'_>,
) -> Result<Vec<AxisGroup>, RefineError> {
    let first =
        trials.first().ok_or_else(|| RefineError::Data("there is no trial to fit on".into()))?;
    if let Some(other) = trials.iter().find(|trial| !first.goes_with(trial)) {
        let count = other.regressions.len();
        return Err(RefineError::Data(format!(
            "the statistics of two trials ({count} regressions) are not of one frame"
        )));
    }
    let mut groups = Vec::new();
    for (index, regression) in first.regressions.iter().enumerate() {
        let parts: Vec<&Moments> =
            trials.iter().map(|trial| &trial.regressions[index].moments).collect();
        match prior {
            Prior::Source(_) => {
                groups.push(group(regression, 0..regression.axes.len(), &parts, prior)?)
            }
            Prior::Family { .. } => {
                for axis in 0..regression.axes.len() {
                    groups.push(group(regression, axis..axis + 1, &parts, prior)?);
                }
            }
        }
    }
    Ok(groups)
}

fn group(
    regression: &Regression,
    axes: std::ops::Range<usize>,
    parts: &[&Moments],
    prior: Prior<'_>,
) -> Result<AxisGroup, RefineError> {
    let names = regression.names[axes.clone()].to_vec();
    let unknown = || {
        RefineError::Data(format!(
            "the prior does not have the coefficients {}",
            names.concat().join(", ")
        ))
    };
    let means: Vec<Vec<f64>> =
        names.iter().map(|names| prior.means(names)).collect::<Option<_>>().ok_or_else(unknown)?;
    let root = match prior.of_axis(&names[0]) {
        Some(axis) => axis.root.clone(),
        None => DMatrix::from_diagonal(&inverse_deviations(regression, parts)?.into()),
    };
    let map = map(&root, &means, &regression.unmixing()?, axes.start);
    let mut parts: Vec<Moments> =
        parts.iter().map(|part| part.mapped(&map, root.ncols())).collect();
    if matches!(prior, Prior::Family { .. }) {
        // As it was learned: a model has no intercept, and what is nearly constant must not be told
        // by its small changes alone.
        parts.iter_mut().for_each(|part| *part = part.about_origin());
    }
    let (without, all) = Moments::leave_one_out(&parts).ok_or_else(unknown)?;
    Ok(AxisGroup {
        axes: regression.axes[axes].to_vec(),
        names,
        means,
        root,
        parts,
        whole: Whitened::new(&all),
        without,
    })
}

/// What makes regressors and targets of what was kept: regressors times the root; targets of each
/// axis less what the mean gives.
fn map(
    root: &DMatrix<f64>,
    means: &[Vec<f64>],
    unmixing: &DMatrix<f64>,
    first: usize,
) -> DMatrix<f64> {
    let (p, kept) = (root.nrows(), unmixing.nrows());
    let mut map = DMatrix::zeros(p + kept, p + means.len());
    map.view_mut((0, 0), (p, p)).copy_from(root);
    for (axis, mean) in means.iter().enumerate() {
        (0..p).for_each(|j| map[(j, p + axis)] = -mean[j]);
        (0..kept).for_each(|target| map[(p + target, p + axis)] = unmixing[(first + axis, target)]);
    }
    map
}

/// By how much a coefficient may move: the inverse of its regressor's deviation, by the root of its
/// shrinkage; not at all where the regressor does not vary.
fn inverse_deviations(
    regression: &Regression,
    parts: &[&Moments],
) -> Result<Vec<f64>, RefineError> {
    let all = Moments::sum(parts.iter().copied()).filter(|all| all.count > 0.0);
    let all = all.ok_or_else(|| RefineError::Data("the trials have no sample".into()))?;
    let one = |(j, shrinkage): (usize, &f64)| {
        let deviation = all.variance(j).sqrt();
        let varies = deviation / all.mean(j).abs().max(1e-300) > 1e-10;
        if varies { 1.0 / (deviation * shrinkage.sqrt()) } else { 0.0 }
    };
    Ok(regression.shrinkage.iter().enumerate().map(one).collect())
}
