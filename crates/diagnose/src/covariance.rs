//! What is not known of an effect's parameters: by noise and slack, and by what no trial tells.

use nalgebra::{Cholesky, DMatrix, DVector};
use sistership_model::effect::ActsOn;

use super::discount::{SHAPE, SIZE};
use super::search::{Judged, Search, priors};
use super::values::{acts_on, own_covariance};
use crate::residual::{Gram, NuisanceKind};

/// How far virtual masses, by strip theory or regression, are from the truth, by the root of the product of the diagonal
/// entries: a judgement.
const MASS: f64 = 0.08;

impl Search<'_> {
    /// The covariance of an effect's parameters, with its false-alarm level on clean trials, what its own law is uncertain
    /// by, and what the virtual masses leave open.
    pub fn covariance(&self, judged: &Judged, place: usize) -> DMatrix<f64> {
        let candidate = &judged.candidates[place];
        let own = own_covariance(&judged.candidates, place, &judged.covariance);
        let change = DVector::from_vec(candidate.change());
        let response = Cholesky::new(own.clone()).map_or(0.0, |factor| change.dot(&factor.solve(&change)));
        // What an instrument says of a motion is exact by definition; what a force does is not.
        let size = if acts_on(candidate) == ActsOn::Measurement { 0.0 } else { SIZE };
        let mut covariance = own * (self.discount(candidate) + SHAPE.powi(2) * response);
        covariance += &change * change.transpose() * size.powi(2);
        if let Some(answers) = self.answers_to_masses(judged, place) {
            covariance += &answers * answers.transpose() * MASS.powi(2);
        }
        covariance
    }

    /// How an effect's parameters answer to each virtual mass, the coefficients giving way by all that is known of them: a
    /// consider analysis (Schmidt 1966, Adv Control Syst 3, 293-340).
    fn answers_to_masses(&self, judged: &Judged, place: usize) -> Option<DMatrix<f64>> {
        let is_mass = |column: &usize| matches!(self.nuisance.get(*column).map(|n| n.kind), Some(NuisanceKind::Mass(..)));
        let size = judged.grams.first()?.products.nrows();
        let total = Gram::sum(&judged.grams, size);
        let (masses, others): (Vec<usize>, Vec<usize>) = (0..size - 1).partition(is_mass);
        let fixing: Vec<f64> = judged.stood.iter().flat_map(priors).map(|prior| prior.deviation.powi(-2)).collect();
        let known = self.nuisance.len();
        let information = |i: usize, j: usize| {
            let before = if i < known && j < known { self.fixed.information[(i, j)] } else { 0.0 };
            let prior = if i == j && i >= known { fixing[i - known] } else { 0.0 };
            total.products[(1 + i, 1 + j)] + before + prior
        };
        let own = DMatrix::from_fn(others.len(), others.len(), |i, j| information(others[i], others[j]));
        let cross = DMatrix::from_fn(others.len(), masses.len(), |i, j| information(others[i], masses[j]));
        let answers = Cholesky::new(own)?.solve(&cross);
        let first: usize = judged.stood[..place].iter().map(|stood| stood.at.len()).sum();
        let start = others.len() - fixing.len() + first;
        Some(answers.rows(start, judged.stood[place].at.len()).into_owned())
    }
}
