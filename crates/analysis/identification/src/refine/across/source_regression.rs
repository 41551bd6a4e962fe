//! A law's coefficients from what a source of another law says, with the covariance that this
//! earns.

use nalgebra::DMatrix;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::quantity::Quantity;

use super::super::blocks::{Block, Blocks};
use super::super::envelope::OperatingEnvelope;
use super::super::outcome::RefineError;
use super::super::ridge::{Choices, Fold, fit};
use super::super::thresholds::SOURCE;
use sistership_numerics::{Moments, RidgeChoice, merged};

/// The statistics of what a source says, as a law's regressions see it.
pub(in super::super) struct SourceRegression<'a> {
    envelope: &'a OperatingEnvelope,
    /// By group and regression.
    moments: Vec<Vec<Moments>>,
    /// Strength of the ridge about zero.
    ridge: f64,
    zero: Model,
    /// Whether a source that does not roll is asked for sway and yaw where the law couples them
    /// with roll.
    plane: bool,
}

impl<'a> SourceRegression<'a> {
    /// Of a law's regressions for the coefficients that a model has; its own values are not read.
    ///
    /// # Errors
    /// The law takes something that the trials do not record.
    pub fn new(
        envelope: &'a OperatingEnvelope,
        blocks: &Blocks,
        model: &Model,
    ) -> Result<Self, RefineError> {
        Self::made(envelope, blocks, model, false)
    }

    /// The same, where a source that does not roll says sway and yaw, of a ship that stays upright,
    /// though the law couples them with roll.
    ///
    /// # Errors
    /// As [`SourceRegression::new`].
    pub fn of_plane(
        envelope: &'a OperatingEnvelope,
        blocks: &Blocks,
        model: &Model,
    ) -> Result<Self, RefineError> {
        Self::made(envelope, blocks, model, true)
    }

    fn made(
        envelope: &'a OperatingEnvelope,
        blocks: &Blocks,
        model: &Model,
        plane: bool,
    ) -> Result<Self, RefineError> {
        let moments = envelope.moments(blocks)?;
        let mut zero = model.clone();
        zero.coefficients.values_mut().for_each(|quantity| quantity.value = 0.0);
        let ridge = SOURCE.ridges[0];
        let mut imitation = Self { envelope, moments, ridge, zero, plane };
        imitation.ridge = imitation.best_ridge(blocks);
        Ok(imitation)
    }

    /// The same of another envelope, by the same ridge.
    ///
    /// # Errors
    /// As [`SourceRegression::new`].
    pub fn of<'b>(
        &self,
        envelope: &'b OperatingEnvelope,
        blocks: &Blocks,
    ) -> Result<SourceRegression<'b>, RefineError> {
        let (moments, zero) = (envelope.moments(blocks)?, self.zero.clone());
        Ok(SourceRegression { envelope, moments, zero, ..*self })
    }

    /// The ridge by which groups left out are foretold best.
    fn best_ridge(&self, blocks: &Blocks) -> f64 {
        let count = self.moments.len().min(SOURCE.folds);
        let folds: Vec<Fold<'_>> = (0..count)
            .filter_map(|fold| {
                let training = merged(&self.moments, |group| group % count != fold)?;
                let left_out = merged(&self.moments, |group| group % count == fold)?;
                Some(Fold::new(blocks, &self.zero, &training, &left_out))
            })
            .collect();
        let is_said = |axis: &Axis| !self.plane || self.says(*axis);
        let of_fold = |fold: &Fold<'_>, ridge: f64| -> f64 {
            let shares = fold.shares(ridge).into_iter();
            shares.filter(|(axis, _)| is_said(axis)).map(|(_, share)| share).sum()
        };
        let error = |ridge: f64| folds.iter().map(|fold| of_fold(fold, ridge)).sum::<f64>();
        SOURCE
            .ridges
            .into_iter()
            .min_by(|a, b| error(*a).total_cmp(&error(*b)))
            .unwrap_or(SOURCE.ridges[0])
    }

    /// Sets a model's coefficients, with standard errors, to what the source says; none of an axis
    /// that it does not know.
    pub fn fill(&self, blocks: &Blocks, model: &mut Model) {
        let fitted = fit(blocks, &self.together(), &self.zero, &self.choices(blocks));
        let known = blocks
            .blocks
            .iter()
            .filter(|block| self.knows(block))
            .flat_map(|block| block.axes.iter().zip(&block.names))
            .filter(|(axis, _)| self.says(**axis))
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

    /// Gives the regressions the precision that this one earns. What the source does not know is
    /// held to where it is, in the deviations of its regressors.
    pub fn hold(&self, blocks: &mut Blocks, trials: &[Moments]) {
        let all = self.together();
        for ((block, source), trials) in blocks.blocks.iter_mut().zip(&all).zip(trials) {
            block.precision = self.knows(block).then(|| earned(block, source, trials));
        }
    }

    /// The statistics of all that the source says, one set per regression.
    pub fn together(&self) -> Vec<Moments> {
        merged(&self.moments, |_| true).unwrap_or_default()
    }

    /// The strength of its ridge.
    pub fn ridge(&self) -> f64 {
        self.ridge
    }

    /// What it has done, for people.
    pub fn words(&self, blocks: &Blocks, law: &str) -> String {
        let samples: usize = self.envelope.groups.iter().map(|group| group.samples.len()).sum();
        let all = self.together();
        let shares = Fold::new(blocks, &self.zero, &all, &all).shares(self.ridge);
        let left = shares
            .iter()
            .filter(|(axis, _)| self.says(*axis))
            .map(|(axis, share)| format!("{:.1} % ({axis})", 100.0 * share))
            .collect::<Vec<_>>()
            .join(", ");
        let (source, own) = (&self.envelope.source, &self.envelope.law);
        let at = if self.envelope.at_own_revolutions {
            ", at its own revolutions, for the trials record none,"
        } else {
            ""
        };
        let words = format!(
            "the source `{source}` is of law `{own}`: what it says in {samples} states of the \
             trials and of its standard manoeuvres{at} is the prior; law `{law}` leaves {left} of \
             the mean square of those accelerations unsaid"
        );
        [words].into_iter().chain(self.envelope.mixed.clone()).collect::<Vec<_>>().join("; ")
    }

    fn knows(&self, block: &Block) -> bool {
        let says = |axis: &Axis| self.says(*axis);
        if self.plane { block.axes.iter().any(says) } else { block.axes.iter().all(says) }
    }

    fn says(&self, axis: Axis) -> bool {
        self.envelope.roll || axis != Axis::K
    }

    fn choices(&self, blocks: &Blocks) -> Choices {
        blocks
            .blocks
            .iter()
            .map(|block| vec![RidgeChoice { lambda: self.ridge, alpha: 0.0 }; block.axes.len()])
            .collect()
    }
}

/// What the source says at every state, and a share (`ignorance`) of what would be needed to say as
/// much of each coefficient alone.
fn earned(block: &Block, source: &Moments, trials: &Moments) -> DMatrix<f64> {
    let p = block.regressors();
    let mut precision = source.raw_products().view((0, 0), (p, p)).into_owned();
    for j in 0..p {
        precision[(j, j)] +=
            SOURCE.ignorance * block.shrinkage[j] * source.variance(j).max(trials.variance(j));
    }
    precision
}
