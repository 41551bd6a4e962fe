//! Estimate of a model of any ship from its particulars.
//!
//! Published regressions (`models/regressions`) each give some of the coefficients and parameters
//! of the law `mmg`. They are combined into a mean and a covariance ([`combined`]), which become a
//! model with the status estimated and its posterior, and uncertainty bands of the standard
//! manoeuvres ([`bands`]).

mod balance;
pub mod bands;
pub mod combined;
mod draws;
mod error;
mod estimate;
pub mod inputs;
mod library;
mod limits;
pub mod particulars;
mod propeller;
mod regression;

pub use bands::{EstimateBands, estimate_bands};
pub use error::EstimateError;
pub use estimate::{EstimateSpread, ShipEstimate, estimate_ship};
pub use library::RegressionLibrary;
pub use regression::{Regression, RegressionValue};

/// Name of the law of estimates.
pub const LAW: &str = "mmg";
