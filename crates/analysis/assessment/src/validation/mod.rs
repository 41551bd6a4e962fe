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
mod trial_of_ship;
mod validation_status;

pub use appraisal::{ModelAppraisal, appraise_model, appraise_vessel};
pub use comparison::{FigureComparison, compare_published};
pub use dataset::{CatalogueEntry, CitedWork};
pub use finding::{ReviewFinding, Severity};
pub use procedure::{Validation, validate};
pub use quantity::{QuantityEvidence, ValidatedQuantity, Verdict};
pub use review::{ShipReview, review_ship};
pub use trial_of_ship::TrialOfShip;
pub use validation_status::ValidationStatus;
