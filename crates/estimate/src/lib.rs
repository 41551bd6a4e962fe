//! From trials to models: similarity of ships, transfer of a model, and refinement of a source
//! model by several estimators.

pub mod bands;
mod estimated;
mod fold_scatter;
pub mod next_trial;
pub mod refine;
pub mod similarity;
pub mod source;
mod steering;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
pub mod transfer;
pub mod trend;
