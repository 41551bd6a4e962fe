//! Models drawn from a posterior.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};
use sistership_model::Model;

/// Largest number of models that are drawn.
const MOST_SAMPLES: usize = 10_000;

/// Sampling of a posterior.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sampling {
    /// Number of models drawn, rounded up to an even number: each draw has its mirror image about
    /// the estimate.
    #[schemars(range(max = 10_000))]
    pub samples: usize,
    /// Seed of the draws.
    pub seed: u64,
}

impl Default for Sampling {
    fn default() -> Self {
        Self { samples: 100, seed: 1 }
    }
}

impl Sampling {
    /// Checks the number of samples.
    ///
    /// # Errors
    /// Returns an error if there are too many.
    pub fn check(&self) -> Result<(), TooManySamples> {
        if self.samples > MOST_SAMPLES { Err(TooManySamples) } else { Ok(()) }
    }
}

/// The error of too many samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("samples must be at most {MOST_SAMPLES}")]
pub struct TooManySamples;

/// Returns models drawn from the posterior of a model; `None` if it has none of its present
/// coefficients, or if no sample is requested.
pub fn draw_from_posterior(model: &Model, sampling: Sampling) -> Option<Vec<Model>> {
    let posterior = model.valid_posterior().filter(|_| sampling.samples > 0)?;
    let root = posterior.covariance_root().ok()?;
    // The range of the trials is checked for the estimate, not for every draw.
    let bare = Model { posterior: None, uncertainty: None, validity: None, ..model.clone() };
    let mut rng = ChaCha12Rng::seed_from_u64(sampling.seed);
    let one = |_| {
        let normal: Vec<f64> = (0..root.len()).map(|_| rng.sample(StandardNormal)).collect();
        let moved: Vec<f64> =
            root.iter().map(|row| row.iter().zip(&normal).map(|(r, z)| r * z).sum()).collect();
        // Antithetic pairs: the mean of the draws is the estimate.
        [1.0, -1.0].map(|side| shift_coefficients(&bare, &posterior.names, &moved, side))
    };
    Some((0..sampling.samples.div_ceil(2)).flat_map(one).collect())
}

/// A model with coefficients shifted to one side of the estimate.
fn shift_coefficients(model: &Model, names: &[String], moved: &[f64], side: f64) -> Model {
    let mut model = model.clone();
    for (name, by) in names.iter().zip(moved) {
        let moved = model.named_value_mut(name).into_iter();
        moved.for_each(|quantity| quantity.value += side * by);
    }
    model
}
