//! Fleets: sufficient statistics of trials, refinement in bulk, and families that share a
//! foundation.

pub mod bulk;
pub mod family;
pub mod statistics;
