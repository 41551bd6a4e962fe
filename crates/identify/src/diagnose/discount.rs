//! How much less than they seem to say trials say of an effect, by what it feigned on clean trials.

use sistership_model::uncertainty::{Feigned, Uncertainty};

use nalgebra::{Cholesky, DMatrix, DVector};
use sistership_model::effect::ActsOn;

use super::search::{Judged, Search};
use super::values::{acts_on, own_covariance};
use crate::residual::Candidate;

/// The law of an effect is a model too: how far the size of what it does is from the truth, and how far the shape.
pub(super) const SIZE: f64 = 0.03;
pub(super) const SHAPE: f64 = 0.003;

impl Search<'_> {
    /// The covariance of an effect's parameters, with what the effect feigns on clean trials and what its own law is
    /// uncertain by.
    pub fn covariance(&self, judged: &Judged, place: usize) -> DMatrix<f64> {
        let candidate = &judged.candidates[place];
        let own = own_covariance(&judged.candidates, place, &judged.covariance);
        let change = DVector::from_vec(candidate.change());
        let response = Cholesky::new(own.clone()).map_or(0.0, |factor| change.dot(&factor.solve(&change)));
        // What an instrument says of a motion is exact by definition; what a force does is not.
        let size = if acts_on(candidate) == ActsOn::Measurement { 0.0 } else { SIZE };
        own * (self.discount(candidate) + SHAPE.powi(2) * response) + &change * change.transpose() * size.powi(2)
    }
}

/// Where a model brings no uncertainty: its coefficients are published ones, and what they cannot follow nobody has measured.
const UNKNOWN: f64 = 10.0;

/// The factor by which the information on an effect is divided.
pub(super) fn discount(uncertainty: Option<&Uncertainty>, candidate: &Candidate, trials: usize) -> f64 {
    let Some(known) = uncertainty else { return UNKNOWN };
    let of = |feigned: &Feigned| {
        // What one size of the effect would suit grows with the number of trials.
        let together = 1.0 + (feigned.together - 1.0) * trials as f64 / known.trials.len().max(1) as f64;
        feigned.each.max(together).max(1.0)
    };
    let own = known.feigned.get(&candidate.key()).map(of);
    own.unwrap_or_else(|| {
        let mut all: Vec<f64> = known.feigned.values().map(of).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(1.0)
    })
}
