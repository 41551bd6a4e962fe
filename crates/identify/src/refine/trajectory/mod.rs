//! The trajectory form: Gauss-Newton on simulated segments with forward sensitivities, damped as by Levenberg and
//! Marquardt, robust as by Huber, started at the weak form and held by it and by the source.
//!
//! With `r` the differences of simulated and measured states, each by its channel's standard deviation, what is least is
//! `mean huber(r) + mu (c - c_weak)' W (c - c_weak) + lambda (c - c_source)' diag(W) (c - c_source)`. `W` is the weak form's
//! Hessian by the mean square of each acceleration: a change of coefficients that changes every acceleration by its own
//! size costs `mu` an axis.

mod errors;
mod normal;
mod options;
mod prior;
mod segments;
mod solve;

pub(super) use errors::Bend;
pub(super) use prior::Prior;
pub(super) use segments::{Plan, Segment, compared, cut};

/// How a motion is cut and weighed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    /// Length of a segment, s.
    pub segment_s: f64,
    /// From one residual to the next, s.
    pub residual_s: f64,
    /// Integration step, s; whole sampling intervals.
    pub step_s: f64,
}
