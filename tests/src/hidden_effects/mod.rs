//! The benchmark of the diagnosis: a true ship that nobody fitted hides an effect, and the
//! diagnosis must name it.
#![allow(clippy::unwrap_used, missing_docs)]

pub mod baseline;
pub mod cases;
pub mod confusion;
pub mod sequence;
pub mod truth;
