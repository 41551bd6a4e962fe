//! Uncertainty of a model's standard manoeuvres: draws from its posterior, the bands that they
//! give, the trial that would narrow these, and the scatter of models that each missed some trials.

mod bands;
mod fold_scatter;
mod next_trial;
mod physical;
mod sampling;

pub use bands::{Band, Bands, bands, bands_over, figures, quantile};
pub use fold_scatter::{FoldQuantile, fold_factor, student};
pub use next_trial::{Drawn, NextTrial};
pub use sampling::{Sampling, TooManySamples, draws};
