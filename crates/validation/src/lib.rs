//! What speaks for a model of the zoo: its standard manoeuvres beside the published free-running
//! trials of its ship, the status that follows, and the checks that a contributed ship passes.

mod appraisal;
mod comparison;
mod finding;
pub mod limits;
mod particulars;
mod physics;
mod review;
mod standing;

pub use appraisal::{Appraisal, appraise, appraise_vessel};
pub use comparison::{Comparison, compare};
pub use finding::{Finding, Severity};
pub use review::{Review, review};
pub use standing::Standing;
