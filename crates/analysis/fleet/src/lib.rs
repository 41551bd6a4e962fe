//! Fleets: sufficient statistics of trials, refinement in bulk, and priors from families of ships
//! with a common foundation.

pub mod bulk;
pub mod family;
pub mod statistics;
