//! Covariance matrix adaptation: minimisation of a function of many numbers by its values alone.
//!
//! The strategy is that of Hansen (2016), The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772,
//! with the constants of its Table 1, including negative weights. Box constraints use an adaptive
//! penalty (Hansen, Niederberger, Guzzella and Koumoutsakos 2009, IEEE Trans Evol Comput 13,
//! 180-197, as implemented in the authors' `pycma` as `BoundPenalty`): every evaluated point is
//! inside the box. A run that has converged restarts with twice the population (Auger and Hansen
//! 2005, Proc. IEEE CEC, 1769-1776).
//!
//! Reasons against existing crates: `basin` has the strategy and this penalty, but evaluates one
//! candidate after the other and decomposes the covariance in every generation; `genoxide` redraws
//! candidates that leave the box, which in hundreds of dimensions are nearly all; `cmaes` and
//! `fcmaes-core` need older versions of `nalgebra` and `rand`.

mod bounds;
mod budget;
mod restarts;
mod strategy;
mod weights;

pub use budget::{SearchBudget, SearchUsage};
pub use restarts::{CmaEsSearch, SearchCancelled, SearchOutcome, SearchState};
pub use strategy::EvolutionStrategy;

#[cfg(test)]
mod tests;
