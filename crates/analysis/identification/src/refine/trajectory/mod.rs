//! The trajectory form: Gauss-Newton on simulated segments with forward sensitivities, damped as by
//! Levenberg and Marquardt, robust as by Huber, started at the weak form, which is also its prior.
//!
//! With `r` the differences of simulated and measured states, each divided by its channel's
//! standard deviation, the objective is `mean huber(r) + mu (c - c_weak)' W (c - c_weak) + mu/(1 +
//! mu) (c - c_source)' L (c - c_source)`. `W` is the weak form's Hessian, each acceleration divided
//! by its mean square: a change of coefficients that changes every acceleration by its own size
//! costs `mu` an axis. `L` is the source's share of `W`; it counts no more than a hundredth of an
//! axis, since the strength that the weak form needs has little relation to the one that
//! trajectories need. A strong `mu` gives the weak form, in which the source has its weight
//! already; with a small one the source must determine the directions on which trajectories have no
//! information, so that it is a prior besides.
//!
//! Where coefficients have typical values with deviations over ships, those alone are the prior, with
//! the strength `mu/(1 + mu)` times a share a square of deviations, and the weak form is the start.
//! Segments are longer then.
//!
//! Nonlinear parameters of the law that trials determine (`prior` in its file) are unknowns
//! besides the coefficients, transformed to stay in their physical range ([`parameters`]). The weak
//! form keeps the source's values; each costs `(mu + mu/(1 + mu))` times a share a square of its
//! prior's deviations.

mod candidates;
mod estimator;
mod fit;
mod normal;
mod parameters;
mod prior;
mod segments;
mod solve;
mod thresholds;

pub(super) use estimator::TrajectoryForm;
pub(super) use prior::WeakFormPrior;
pub(super) use segments::{
    ComparisonPlan, SegmentLengths, TrialSegment, compared_states, divide_into_segments,
};

#[cfg(test)]
mod tests;
