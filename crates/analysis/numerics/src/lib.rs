//! Linear regression with a prior: sufficient statistics, and the full path of ridge solutions from
//! one decomposition.

mod alpha_error;
pub mod cma_es;
mod metric;
mod moments;
mod path;
mod scatter;
mod whitened;

pub use alpha_error::AlphaError;
pub use metric::PriorMetric;
pub use moments::{RegressionMoments, merge_trials};
pub use path::{RidgeChoice, RidgePath, ValidationSamples};
pub use scatter::RobustScatter;
pub use whitened::WhitenedPath;
