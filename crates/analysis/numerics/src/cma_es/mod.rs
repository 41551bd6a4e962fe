//! Covariance matrix adaptation: a search that needs nothing but values of a function of many
//! numbers.
//!
//! The strategy is that of Hansen (2016), The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772,
//! with the constants of its Table 1, negative weights included. Boxes are kept by an adaptive
//! penalty (Hansen, Niederberger, Guzzella and Koumoutsakos 2009, IEEE Trans Evol Comput 13,
//! 180-197, as the authors' `pycma` has it in `BoundPenalty`): what is evaluated is always inside.
//! A run that has converged starts again with twice the population (Auger and Hansen 2005, Proc.
//! IEEE CEC, 1769-1776).
//!
//! Crates were weighed first. Of those kept up, `basin` has the strategy and this penalty, but
//! evaluates one candidate after the other and decomposes the covariance in every generation;
//! `genoxide` draws again what leaves the box, which among hundreds of coordinates is everything;
//! `cmaes` and `fcmaes-core` need older `nalgebra` and `rand`.

mod bounds;
mod budget;
mod restarts;
mod strategy;
mod weights;

pub use budget::{Budget, Spent};
pub use restarts::{CmaEsSearch, SearchCancelled, SearchOutcome, SearchState};
pub use strategy::Strategy;

#[cfg(test)]
mod tests;
