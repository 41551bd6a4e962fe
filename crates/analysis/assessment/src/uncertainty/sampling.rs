//! Models drawn from a posterior.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};
use sistership_model::Model;

/// Most models that are drawn.
const MOST_SAMPLES: usize = 10_000;

/// How a posterior is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sampling {
    /// Models drawn, an even number: each draw has its mirror image about the estimate.
    #[schemars(range(max = 10_000))]
    pub samples: usize,
    /// What the draws follow from.
    pub seed: u64,
    /// Draws reverse the rudder within a step, are held against the estimate at a fine one, and
    /// tell the trial that would help most. The default search sets it; versions made by explicit
    /// calls keep the bands that they have.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub within_steps: bool,
    /// Draws end initial turns soon after the change of heading that is asked for. The default
    /// search sets it, as `within_steps`.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub figures_only: bool,
}

impl Default for Sampling {
    fn default() -> Self {
        Self { samples: 100, seed: 1, within_steps: false, figures_only: false }
    }
}

impl Sampling {
    /// Checks the number of samples.
    ///
    /// # Errors
    /// Says what it may be.
    pub fn check(&self) -> Result<(), TooManySamples> {
        if self.samples > MOST_SAMPLES { Err(TooManySamples) } else { Ok(()) }
    }
}

/// More samples than are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("samples must be at most {MOST_SAMPLES}")]
pub struct TooManySamples;

/// Models drawn from the posterior of one; none where it has none, or none of its present
/// coefficients, or where no sample is asked for.
pub fn draws(model: &Model, sampling: Sampling) -> Option<Vec<Model>> {
    let posterior = model.posterior().filter(|_| sampling.samples > 0)?;
    let root = posterior.root().ok()?;
    // What the trials covered is asked of the estimate, not of every draw.
    let bare = Model { posterior: None, uncertainty: None, validity: None, ..model.clone() };
    let mut rng = ChaCha12Rng::seed_from_u64(sampling.seed);
    let one = |_| {
        let normal: Vec<f64> = (0..root.len()).map(|_| rng.sample(StandardNormal)).collect();
        let moved: Vec<f64> =
            root.iter().map(|row| row.iter().zip(&normal).map(|(r, z)| r * z).sum()).collect();
        [1.0, -1.0].map(|side| shifted(&bare, &posterior.names, &moved, side))
    };
    Some((0..sampling.samples.div_ceil(2)).flat_map(one).collect())
}

/// A model with coefficients moved.
fn shifted(model: &Model, names: &[String], moved: &[f64], side: f64) -> Model {
    let mut model = model.clone();
    for (name, by) in names.iter().zip(moved) {
        model
            .coefficients
            .get_mut(name)
            .into_iter()
            .for_each(|quantity| quantity.value += side * by);
    }
    model
}
