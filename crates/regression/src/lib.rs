//! Linear regression with a prior: sufficient statistics, and the whole path of ridge solutions
//! from one decomposition.

pub mod cma_es;
mod metric;
mod moments;
mod path;
mod whitened;

pub use metric::Metric;
pub use moments::Moments;
pub use path::{RidgeChoice, RidgePath, Validation};
pub use whitened::Whitened;
