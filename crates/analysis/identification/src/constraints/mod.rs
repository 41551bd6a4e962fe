//! What a refined model must keep to, whatever the trials say.
//!
//! The ridge's solution is the least of a quadratic, so that the least of it within convex limits
//! is the limits' point that is nearest to the solution by the quadratic's own curvature: a cone
//! programme, which Clarabel solves.

mod conflict;
mod error;
mod limit;
mod limits;
mod programme;
mod settings;
mod straight;
mod thresholds;

pub use error::LimitError;
pub use limits::CoefficientLimits;
pub use settings::{Bound, ConstraintError, Constraints, StraightLine};

#[cfg(test)]
mod tests;
