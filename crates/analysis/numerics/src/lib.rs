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
pub use metric::Metric;
pub use moments::{Moments, merged};
pub use path::{RidgeChoice, RidgePath, Validation};
pub use scatter::Scatter;
pub use whitened::Whitened;
