//! Constraints on the coefficients of a refined model, which hold whatever the trials suggest.
//!
//! The ridge's solution is the minimum of a quadratic function. Its minimum within convex limits is
//! therefore the point of the limits that is nearest to the solution in the metric of the
//! quadratic's own curvature: a cone programme, which Clarabel solves.

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
