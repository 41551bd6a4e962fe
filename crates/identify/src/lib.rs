//! Inverse: from trials to models. Similarity of ships, refinement of a source model, and what the residual says.

pub mod bands;
pub mod bulk;
pub mod cma_es;
pub mod diagnose;
pub mod family;
pub mod refine;
pub mod regression;
pub mod residual;
pub mod similarity;
pub mod source;
pub mod statistics;
#[cfg(test)]
mod testing;
pub mod transfer;
