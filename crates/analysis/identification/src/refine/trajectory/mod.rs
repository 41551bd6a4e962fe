//! The trajectory form: Gauss-Newton on simulated segments with forward sensitivities, damped as by
//! Levenberg and Marquardt, robust as by Huber, started at the weak form and held by it.
//!
//! With `r` the differences of simulated and measured states, each by its channel's standard
//! deviation, what is least is `mean huber(r) + mu (c - c_weak)' W (c - c_weak) + mu/(1 + mu) (c -
//! c_source)' L (c - c_source)`. `W` is the weak form's Hessian by the mean square of each
//! acceleration: a change of coefficients that changes every acceleration by its own size costs
//! `mu` an axis. `L` is the source's share of `W`; it counts no more than a hundredth of an axis,
//! since how much the weak form needs says little of how much trajectories do. A strong `mu` gives
//! the weak form, where the source has its weight already; with a small one the source has to hold
//! what trajectories say nothing of, so that it pulls besides.

mod candidates;
mod estimator;
mod fit;
mod normal;
mod prior;
mod segments;
mod solve;
mod thresholds;

pub(super) use estimator::TrajectoryForm;
pub(super) use prior::WeakFormPrior;
pub(super) use segments::{ComparisonPlan, Segment, SegmentLengths, compared, cut};
