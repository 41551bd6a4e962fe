//! The search by CMA-ES, as Miyauchi, Akimoto and Maki (2024) refine the Abkowitz-MMG hybrid: no
//! slopes, only simulations.
//!
//! What is least is their Eq. 20 by the duration `T` of the trials, `(L + alpha P_div + lambda
//! |theta|_1)/T`: `L` the squared differences of simulated and measured `u, v, r`, standardised,
//! integrated over subsequences that start anew from what was measured (Eq. 21); `P_div` the share
//! of extreme states and controls from which the accelerations leave what was measured (Eqs. 29 to
//! 33); and the sizes of the parameters. Departures: standard deviations are those over all trials,
//! since a subsequence in which little moves would count most; and a simulation that leaves the
//! physical range counts a fixed large error from there on, instead of the substitution of Eq. 25,
//! with the same order among candidates: who goes on longer is better.
//!
//! A parameter is a coefficient's distance from the source by its own natural size: the change that
//! changes an acceleration by the acceleration's own root mean square over the trials. The box is
//! so many of these to either side (about ten, as theirs is about ten times what is known
//! beforehand, sec. 3.2), whatever the law's scaling.

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
