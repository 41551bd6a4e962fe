//! From trials to models: refinement of a source model by several estimators.

pub mod constraints;
pub mod refine;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
