//! Uncertainty of a model's standard manoeuvres: draws from its posterior, the bands that they
//! give, the trial that would narrow these, and the scatter of models that each missed some trials.

mod bands;
mod fold_scatter;
mod next_trial;
mod physical;
mod sampling;

pub use bands::{
    UncertaintyBand, UncertaintyBands, bands_over, figures_by_name, quantile, uncertainty_bands,
};
pub use fold_scatter::{fold_factor, student_quantile};
pub use next_trial::{DrawFigures, NextTrial};
pub use sampling::{Sampling, TooManySamples, draw_from_posterior};
