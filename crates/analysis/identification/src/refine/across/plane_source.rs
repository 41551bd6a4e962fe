//! A 3-DOF source of another law, as the prior of a law with roll (4-DOF).
//!
//! Its accelerations are those of a ship that stays upright. They are regressed on the terms of
//! surge, sway and yaw without heel, for which they are the prior jointly. They have no information
//! on roll and on the effects of heel: roll begins with hydrostatics, and each of those terms is
//! measured by its size in the manoeuvres of the model so begun, where the ship heels further than
//! in trials.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Trial;
use sistership_numerics::{RegressionMoments, merge_trials};
use sistership_priors::rolling::hydrostatic_coefficients;

use super::super::blocks::{RegressionBlock, RegressionBlocks};
use super::super::envelope::OperatingEnvelope;
use super::super::family::terms_without_heel;
use super::super::outcome::RefineError;
use super::SourceRegression;

/// The prior from a source of the plane.
pub(in super::super) struct PlaneSource {
    /// Envelope of the upright ship.
    upright: Arc<OperatingEnvelope>,
    /// Envelope of the model that begins with it; none if that cannot be simulated.
    sailed: Option<OperatingEnvelope>,
}

impl PlaneSource {
    /// Creates the prior from the accelerations of an upright ship, and sets a model's coefficients
    /// to them; a model without coefficients gets the terms without heel first.
    ///
    /// # Errors
    /// Returns an error if the law has an input that the trials do not record.
    pub fn from_upright(
        upright: Arc<OperatingEnvelope>,
        model: &mut Model,
        law: &Law,
        trials: &[&Trial],
    ) -> Result<Self, RefineError> {
        if model.coefficients.is_empty() {
            let zero = |name| (name, Quantity::new(0.0, "term added"));
            model.coefficients.extend(terms_without_heel(law).into_iter().map(zero));
        }
        let blocks = RegressionBlocks::new(model, law)?;
        SourceRegression::new_upright(&upright, &blocks, model)?.set_coefficients(&blocks, model);
        // Only now: the regression must not assign upright accelerations to terms of heel.
        model.coefficients.extend(hydrostatic_coefficients(model, law).into_iter().flatten());
        let sailed = OperatingEnvelope::new(model, law, trials).ok();
        Ok(Self { upright, sailed })
    }

    /// Gives a model's regressions their precision, and the model the coefficients of the source.
    ///
    /// # Errors
    /// Returns an error if the law has an input that the trials do not record.
    pub fn apply_to(
        &self,
        blocks: &mut RegressionBlocks,
        model: &mut Model,
        trials: &[RegressionMoments],
    ) -> Result<(), RefineError> {
        let upright = SourceRegression::new_upright(&self.upright, blocks, model)?;
        upright.set_coefficients(blocks, model);
        upright.set_precision(blocks, trials);
        let said = upright.merged_moments();
        let sailed = match &self.sailed {
            Some(sailed) => {
                merge_trials(&sailed.group_moments(blocks)?, |_| true).unwrap_or_default()
            }
            None => trials.to_vec(),
        };
        let of_blocks = blocks.blocks.iter_mut().zip(&said).zip(&sailed).zip(trials);
        for (((block, said), sailed), trials) in of_blocks {
            block.precision =
                Some(precision_with_sizes(block, said, &block.regressor_sizes(sailed, trials)));
        }
        Ok(())
    }

    /// Description for reports.
    pub fn describe_source(
        &self,
        blocks: &RegressionBlocks,
        model: &Model,
        law: &Law,
    ) -> Option<String> {
        let upright = SourceRegression::new_upright(&self.upright, blocks, model).ok()?;
        Some(format!(
            "{}; the source has no roll: terms with roll have a prior of zero, scaled by their \
             size in simulated manoeuvres",
            upright.describe_source(blocks, &law.name)
        ))
    }
}

/// The precision of a regression, in which terms without information from the source are measured
/// each by its size.
fn precision_with_sizes(
    block: &RegressionBlock,
    said: &RegressionMoments,
    sizes: &DVector<f64>,
) -> DMatrix<f64> {
    let Some(mut precision) = block.precision.clone() else {
        return DMatrix::from_diagonal(sizes);
    };
    let squares = said.raw_products().diagonal();
    // A regressor that is zero at every upright state is one of the heel.
    for place in (0..block.regressor_count()).filter(|place| squares[*place] == 0.0) {
        precision.row_mut(place).fill(0.0);
        precision.column_mut(place).fill(0.0);
        precision[(place, place)] = sizes[place];
    }
    precision
}
