//! A source of another law that does not roll, as the prior of a law with roll.
//!
//! What it says it says of a ship that stays upright. It is regressed on the terms of surge, sway
//! and yaw that have no heel in them, which are held by it jointly. Of roll and of what the heel
//! does it says nothing: roll begins with hydrostatics, and each of those terms is held by its size
//! in the manoeuvres that the model so begun sails, where the ship heels further than in trials.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Trial;
use sistership_numerics::{Moments, merged};
use sistership_priors::rolling::hydrostatics;

use super::super::blocks::{Block, Blocks};
use super::super::envelope::OperatingEnvelope;
use super::super::family::terms_without_heel;
use super::super::outcome::RefineError;
use super::SourceRegression;

/// What is held by a source of the plane.
pub(in super::super) struct PlaneSource {
    /// What it says, upright.
    upright: Arc<OperatingEnvelope>,
    /// Where the model that begins with it sails; none where it does not.
    sailed: Option<OperatingEnvelope>,
}

impl PlaneSource {
    /// Of what a source says upright; a model that knows nothing yet says the same then.
    ///
    /// # Errors
    /// The law takes something that the trials do not record.
    pub fn begin(
        upright: Arc<OperatingEnvelope>,
        model: &mut Model,
        law: &Law,
        trials: &[&Trial],
    ) -> Result<Self, RefineError> {
        if model.coefficients.is_empty() {
            let zero = |name| (name, Quantity::new(0.0, "term added"));
            model.coefficients.extend(terms_without_heel(law).into_iter().map(zero));
        }
        let blocks = Blocks::new(model, law)?;
        SourceRegression::of_plane(&upright, &blocks, model)?.fill(&blocks, model);
        model.coefficients.extend(hydrostatics(model, law).into_iter().flatten());
        let sailed = OperatingEnvelope::new(model, law, trials).ok();
        Ok(Self { upright, sailed })
    }

    /// Gives a model's regressions their precision, and the model what the source says.
    ///
    /// # Errors
    /// As [`PlaneSource::begin`].
    pub fn hold(
        &self,
        blocks: &mut Blocks,
        model: &mut Model,
        trials: &[Moments],
    ) -> Result<(), RefineError> {
        let upright = SourceRegression::of_plane(&self.upright, blocks, model)?;
        upright.fill(blocks, model);
        upright.hold(blocks, trials);
        let said = upright.together();
        let sailed = match &self.sailed {
            Some(sailed) => merged(&sailed.moments(blocks)?, |_| true).unwrap_or_default(),
            None => trials.to_vec(),
        };
        let of_blocks = blocks.blocks.iter_mut().zip(&said).zip(&sailed).zip(trials);
        for (((block, said), sailed), trials) in of_blocks {
            block.precision = Some(unsaid_by_size(block, said, &block.sizes(sailed, trials)));
        }
        Ok(())
    }

    /// What it is, for people.
    pub fn words(&self, blocks: &Blocks, model: &Model, law: &Law) -> Option<String> {
        let upright = SourceRegression::of_plane(&self.upright, blocks, model).ok()?;
        Some(format!(
            "{}; that is of a ship that stays upright, and terms of the heel are held at \
             zero by their size in the manoeuvres that the prior sails",
            upright.words(blocks, &law.name)
        ))
    }
}

/// A regression's precision, where terms of which the source says nothing are held each by its
/// size.
fn unsaid_by_size(block: &Block, said: &Moments, sizes: &DVector<f64>) -> DMatrix<f64> {
    let Some(mut precision) = block.precision.clone() else {
        return DMatrix::from_diagonal(sizes);
    };
    let squares = said.raw_products().diagonal();
    for place in (0..block.regressors()).filter(|place| squares[*place] == 0.0) {
        precision.row_mut(place).fill(0.0);
        precision.column_mut(place).fill(0.0);
        precision[(place, place)] = sizes[place];
    }
    precision
}
