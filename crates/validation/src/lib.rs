//! What speaks for a model of the zoo: its standard manoeuvres beside the published free-running
//! trials of its ship, the status that follows, the checks that a contributed ship
//! passes, and its entry in catalogues.

mod appraisal;
mod comparison;
mod dataset;
mod finding;
pub mod limits;
mod particulars;
mod physics;
mod review;
mod standing;

pub use appraisal::{Appraisal, appraise, appraise_vessel};
pub use comparison::{Comparison, compare};
pub use dataset::{Dataset, Work};
pub use finding::{Finding, Severity};
pub use review::{Review, review};
pub use standing::Standing;
