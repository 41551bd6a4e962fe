//! A law's coefficients from what a source of another law says, with the covariance that this
//! earns.

use nalgebra::DMatrix;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::quantity::Quantity;

use super::super::blocks::{Block, Blocks};
use super::super::envelope::OperatingEnvelope;
use super::super::merged::merged;
use super::super::outcome::RefineError;
use super::super::ridge::{Choices, Fold, fit};
use super::super::thresholds::SOURCE;
use sistership_regression::{Moments, RidgeChoice};

/// The statistics of what a source says, as a law's regressions see it.
pub(in super::super) struct SourceRegression<'a> {
    envelope: &'a OperatingEnvelope,
    /// By group and regression.
    moments: Vec<Vec<Moments>>,
    /// Strength of the ridge about zero.
    ridge: f64,
    zero: Model,
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
        let moments = envelope.moments(blocks)?;
        let mut zero = model.clone();
        zero.coefficients.values_mut().for_each(|quantity| quantity.value = 0.0);
        let mut imitation = Self { envelope, moments, ridge: SOURCE.ridges[0], zero };
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
        Ok(SourceRegression { envelope, moments, ridge: self.ridge, zero })
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
        let error = |ridge: f64| {
            folds
                .iter()
                .map(|fold| fold.shares(ridge).iter().map(|(_, share)| share).sum::<f64>())
                .sum::<f64>()
        };
        SOURCE
            .ridges
            .into_iter()
            .min_by(|a, b| error(*a).total_cmp(&error(*b)))
            .unwrap_or(SOURCE.ridges[0])
    }

    /// Sets a model's coefficients, with standard errors, to what the source says; none of an axis
    /// that it does not know.
    pub fn fill(&self, blocks: &Blocks, model: &mut Model) {
        let Some(all) = merged(&self.moments, |_| true) else { return };
        let fitted = fit(blocks, &all, &self.zero, &self.choices(blocks));
        let known = blocks
            .blocks
            .iter()
            .filter(|block| self.knows(block))
            .flat_map(|block| block.names.iter().flatten());
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
        let Some(all) = merged(&self.moments, |_| true) else { return };
        for ((block, source), trials) in blocks.blocks.iter_mut().zip(&all).zip(trials) {
            block.precision = self.knows(block).then(|| earned(block, source, trials));
        }
    }

    /// The strength of its ridge.
    pub fn ridge(&self) -> f64 {
        self.ridge
    }

    /// What it has done, for people.
    pub fn words(&self, blocks: &Blocks, law: &str) -> String {
        let samples: usize = self.envelope.groups.iter().map(|group| group.samples.len()).sum();
        let all = merged(&self.moments, |_| true).unwrap_or_default();
        let shares = Fold::new(blocks, &self.zero, &all, &all).shares(self.ridge);
        let left = shares
            .iter()
            .map(|(axis, share)| format!("{:.1} % ({axis})", 100.0 * share))
            .collect::<Vec<_>>()
            .join(", ");
        let (source, own) = (&self.envelope.source, &self.envelope.law);
        format!(
            "the source `{source}` is of law `{own}`: what it says in {samples} states of the \
             trials and of its standard manoeuvres is the prior; law `{law}` leaves {left} of the \
             mean square of those accelerations unsaid"
        )
    }

    fn knows(&self, block: &Block) -> bool {
        self.envelope.roll || !block.axes.contains(&Axis::K)
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
