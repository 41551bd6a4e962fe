//! Linear regression with a prior: sufficient statistics, and the whole path of ridge solutions from one decomposition.

mod moments;
mod path;
mod whitened;

pub use moments::Moments;
pub use path::{Choice, RidgePath, Validation};
pub use whitened::Whitened;
