//! Coefficients of a law from the accelerations of a source of another law, with the covariance
//! that follows.

use nalgebra::DMatrix;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::quantity::Quantity;

use super::super::blocks::{RegressionBlock, RegressionBlocks};
use super::super::envelope::OperatingEnvelope;
use super::super::outcome::RefineError;
use super::super::ridge::{RegressionFold, RidgeChoices, fit_regressions};
use super::super::thresholds::SOURCE;
use sistership_numerics::{RegressionMoments, RidgeChoice, merge_trials};

/// Statistics of a source's accelerations for the regressions of a law.
pub(in super::super) struct SourceRegression<'a> {
    envelope: &'a OperatingEnvelope,
    /// Statistics by group and regression.
    moments: Vec<Vec<RegressionMoments>>,
    /// Strength of the ridge about zero.
    ridge: f64,
    zero: Model,
    /// True if a source that does not roll determines sway and yaw although the law couples them
    /// with roll.
    plane: bool,
}

impl<'a> SourceRegression<'a> {
    /// Creates the regressions of a law for the coefficients that a model has; the model's own
    /// values are not read.
    ///
    /// # Errors
    /// Returns an error if the law has an input that the trials do not record.
    pub fn new(
        envelope: &'a OperatingEnvelope,
        blocks: &RegressionBlocks,
        model: &Model,
    ) -> Result<Self, RefineError> {
        Self::with_best_ridge(envelope, blocks, model, false)
    }

    /// As [`SourceRegression::new`], for a source that does not roll and determines sway and yaw of
    /// a ship that stays upright although the law couples them with roll.
    ///
    /// # Errors
    /// As [`SourceRegression::new`].
    pub fn new_upright(
        envelope: &'a OperatingEnvelope,
        blocks: &RegressionBlocks,
        model: &Model,
    ) -> Result<Self, RefineError> {
        Self::with_best_ridge(envelope, blocks, model, true)
    }

    /// The regressions, with the best of the ridges that are tried.
    fn with_best_ridge(
        envelope: &'a OperatingEnvelope,
        blocks: &RegressionBlocks,
        model: &Model,
        plane: bool,
    ) -> Result<Self, RefineError> {
        let moments = envelope.group_moments(blocks)?;
        // The ridge is about zero, whatever the model's present values are.
        let mut zero = model.clone();
        zero.coefficients.values_mut().for_each(|quantity| quantity.value = 0.0);
        let ridge = SOURCE.ridges[0];
        let mut imitation = Self { envelope, moments, ridge, zero, plane };
        imitation.ridge = imitation.best_ridge(blocks);
        Ok(imitation)
    }

    /// Returns the regressions of another envelope with the same ridge.
    ///
    /// # Errors
    /// As [`SourceRegression::new`].
    pub fn for_envelope<'b>(
        &self,
        envelope: &'b OperatingEnvelope,
        blocks: &RegressionBlocks,
    ) -> Result<SourceRegression<'b>, RefineError> {
        let (moments, zero) = (envelope.group_moments(blocks)?, self.zero.clone());
        Ok(SourceRegression { envelope, moments, zero, ..*self })
    }

    /// The strength of the ridge by which held-out groups are predicted best.
    fn best_ridge(&self, blocks: &RegressionBlocks) -> f64 {
        // Groups (trials and manoeuvres) are held out together, not samples, which depend on each
        // other.
        let count = self.moments.len().min(SOURCE.folds);
        let folds: Vec<RegressionFold<'_>> = (0..count)
            .filter_map(|fold| {
                let training = merge_trials(&self.moments, |group| group % count != fold)?;
                let left_out = merge_trials(&self.moments, |group| group % count == fold)?;
                Some(RegressionFold::new(blocks, &self.zero, &training, &left_out))
            })
            .collect();
        let is_said = |axis: &Axis| !self.plane || self.covers_axis(*axis);
        let of_fold = |fold: &RegressionFold<'_>, ridge: f64| -> f64 {
            let shares = fold.error_shares(ridge).into_iter();
            shares.filter(|(axis, _)| is_said(axis)).map(|(_, share)| share).sum()
        };
        // Sum over folds and axes of the unexplained share of the mean square.
        let error = |ridge: f64| folds.iter().map(|fold| of_fold(fold, ridge)).sum::<f64>();
        SOURCE
            .ridges
            .into_iter()
            .min_by(|a, b| error(*a).total_cmp(&error(*b)))
            .unwrap_or(SOURCE.ridges[0])
    }

    /// Sets a model's coefficients, with standard errors, to those of the regression; axes that the
    /// source does not cover stay as they are.
    pub fn set_coefficients(&self, blocks: &RegressionBlocks, model: &mut Model) {
        // All groups at once: the coefficients use every state.
        let fitted = fit_regressions(
            blocks,
            &self.merged_moments(),
            &self.zero,
            &self.ridge_choices(blocks),
        );
        let known = blocks
            .blocks
            .iter()
            .filter(|block| self.covers_block(block))
            .flat_map(|block| block.axes.iter().zip(&block.names))
            .filter(|(axis, _)| self.covers_axis(**axis))
            .flat_map(|(_, names)| names);
        for name in known {
            let Some(fitted) = fitted.coefficients.get(name) else { continue };
            let source = format!("regressed on {}", self.envelope.source);
            let quantity = Quantity {
                standard_error: Some(fitted.standard_error),
                ..Quantity::new(fitted.value, source)
            };
            model.coefficients.insert(name.clone(), quantity);
        }
    }

    /// Gives the regressions of a law the precision that the source determines. Regressions that it
    /// does not cover keep none, so that their prior is measured by the deviations of their
    /// regressors.
    pub fn set_precision(&self, blocks: &mut RegressionBlocks, trials: &[RegressionMoments]) {
        let all = self.merged_moments();
        for ((block, source), trials) in blocks.blocks.iter_mut().zip(&all).zip(trials) {
            block.precision =
                self.covers_block(block).then(|| source_precision(block, source, trials));
        }
    }

    /// The statistics of all groups together, one set for each regression.
    pub fn merged_moments(&self) -> Vec<RegressionMoments> {
        merge_trials(&self.moments, |_| true).unwrap_or_default()
    }

    /// Strength of its ridge.
    pub fn ridge_strength(&self) -> f64 {
        self.ridge
    }

    /// Description for reports.
    pub fn describe_source(&self, blocks: &RegressionBlocks, law: &str) -> String {
        let samples: usize = self.envelope.groups.iter().map(|group| group.samples.len()).sum();
        let all = self.merged_moments();
        let shares = RegressionFold::new(blocks, &self.zero, &all, &all).error_shares(self.ridge);
        let left = shares
            .iter()
            .filter(|(axis, _)| self.covers_axis(*axis))
            .map(|(axis, share)| format!("{:.1} % ({axis})", 100.0 * share))
            .collect::<Vec<_>>()
            .join(", ");
        let (source, own) = (&self.envelope.source, &self.envelope.law);
        let at = if self.envelope.at_own_revolutions {
            ", at its own revolutions because the trials have none,"
        } else {
            ""
        };
        let words = format!(
            "the source `{source}` has the law `{own}`: its accelerations in {samples} states of \
             the trials and of its standard manoeuvres{at} are the prior; law `{law}` does not \
             represent {left} of their mean square"
        );
        [words].into_iter().chain(self.envelope.mixed.clone()).collect::<Vec<_>>().join("; ")
    }

    /// Returns true if the source covers a regression: all of its axes, or any of them for a source
    /// of the plane.
    fn covers_block(&self, block: &RegressionBlock) -> bool {
        let says = |axis: &Axis| self.covers_axis(*axis);
        if self.plane { block.axes.iter().any(says) } else { block.axes.iter().all(says) }
    }

    /// Returns true if the source covers an axis.
    fn covers_axis(&self, axis: Axis) -> bool {
        self.envelope.roll || axis != Axis::K
    }

    /// Choices of its ridge for every target.
    fn ridge_choices(&self, blocks: &RegressionBlocks) -> RidgeChoices {
        blocks
            .blocks
            .iter()
            .map(|block| vec![RidgeChoice { lambda: self.ridge, alpha: 0.0 }; block.axes.len()])
            .collect()
    }
}

/// The precision that a source determines: the products of the regressors at every state, and a
/// share (`ignorance`) of the precision that would determine each coefficient alone.
fn source_precision(
    block: &RegressionBlock,
    source: &RegressionMoments,
    trials: &RegressionMoments,
) -> DMatrix<f64> {
    let p = block.regressor_count();
    let mut precision = source.raw_products().view((0, 0), (p, p)).into_owned();
    for j in 0..p {
        precision[(j, j)] += SOURCE.ignorance
            * block.shrinkage[j]
            * source.regressor_variance(j).max(trials.regressor_variance(j));
    }
    precision
}
