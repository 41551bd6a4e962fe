//! From trials to models: similarity of ships, transfer of a model, and refinement of a source
//! model by several estimators.

mod estimated;
pub mod refine;
pub mod similarity;
pub mod source;
mod steering;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
pub mod transfer;
pub mod trend;
