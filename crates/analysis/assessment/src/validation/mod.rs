//! Evidence for the models of the zoo: standard manoeuvres compared with the published free-running
//! trials of the ship, the status that follows, the checks of a contributed ship, its entry in
//! catalogues, and the validation of any model by ITTC 7.5-02-06-03.

mod appraisal;
mod comparison;
mod convergence;
mod dataset;
mod finding;
pub mod limits;
mod particulars;
mod physics;
mod procedure;
mod published;
mod quantity;
mod recorded;
mod review;
mod standing;
mod trial_of_ship;

pub use appraisal::{Appraisal, appraise, appraise_vessel};
pub use comparison::{Comparison, compare};
pub use dataset::{Dataset, Work};
pub use finding::{Finding, Severity};
pub use procedure::{Validation, validate};
pub use quantity::{Evidence, ValidatedQuantity, Verdict};
pub use review::{Review, review};
pub use standing::Standing;
pub use trial_of_ship::TrialOfShip;
