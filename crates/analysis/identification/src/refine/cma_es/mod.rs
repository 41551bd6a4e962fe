//! The search by CMA-ES, as Miyauchi, Akimoto and Maki (2024) refine the Abkowitz-MMG hybrid:
//! simulations only, without derivatives.
//!
//! The objective is their Eq. 20 divided by the duration `T` of the trials, `(L + alpha P_div +
//! lambda |theta|_1)/T`: `L` is the sum of the squared differences of simulated and measured `u, v,
//! r`, standardised, integrated over subsequences that start anew from the measurement (Eq. 21);
//! `P_div` is the share of extreme states and controls from which the accelerations exceed the
//! measured ones (Eqs. 29 to 33); the last term has the sizes of the parameters. Departures:
//! standard deviations are those over all trials, since a subsequence with little motion would
//! count most; and a simulation that leaves the physical range counts a fixed large error from
//! there on, instead of the substitution of Eq. 25, with the same order among candidates: a longer
//! simulation is better.
//!
//! A parameter is a coefficient's distance from the source in units of its natural size: the change
//! that changes an acceleration by the acceleration's own root mean square over the trials. The box
//! is a number of these to either side (about ten, as theirs is about ten times the prior
//! knowledge, sec. 3.2), whatever the law's scaling.

mod candidates;
mod deviation;
mod estimator;
mod objective;
mod settings;
mod thresholds;

pub(super) use estimator::CovarianceMatrixAdaptation;
pub use settings::{CmaEs, SearchReport};

#[cfg(test)]
mod tests;
