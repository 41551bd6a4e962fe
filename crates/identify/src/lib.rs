//! Inverse: from trials to models. Similarity of ships, refinement of a source model, and what the residual says.

pub mod bands;
pub mod diagnose;
pub mod refine;
pub mod regression;
pub mod residual;
pub mod similarity;
pub mod source;
pub mod transfer;
