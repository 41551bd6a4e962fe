//! Trial design: the set of manoeuvres, speeds and headings that reduces the uncertainty bands of
//! the IMO criteria most in a given time.
//!
//! The information of a trial on the model's coefficients is that of the filter of the diagnosis
//! (`sistership_diagnosis::ExpectedInformation`). With a normal posterior of covariance `R R'` and
//! coefficients `R z`, `z` has the covariance `(I + sum_i R' F_i R)^-1` after the trials of a
//! design; a figure that changes by `g` with `z` then has the variance `g' (I + sum_i R' F_i R)^-1
//! g`. The design minimises the mean logarithm of the figures' deviations: a compound of c-optimal
//! designs, in which metres and degrees need no weights, as the differences of a logarithm of a
//! product do not depend on units (Atkinson and Donev 1992, Optimum experimental designs, chapters
//! 9 to 11; Ljung 1999, System identification, 2nd edition, chapter 13; Chaloner and Verdinelli
//! 1995, Statistical Science 10, 273-304, for designs by a posterior). It is found by adding the
//! candidate with the largest gain per minute and then exchanging (Fedorov 1972, Theory of optimal
//! experiments, chapter 3).

mod candidates;
mod course;
mod design;
mod error;
mod expected;
mod instruments;
mod outcome;
mod plan;
mod report;
mod request;
mod search;
mod setting;
mod targets;
mod thresholds;
mod unknowns;

pub use error::PlanError;
pub use instruments::InstrumentAccuracy;
pub use outcome::{ExpectedBand, PlannedTrial, StandardProgramme, TrialPlan};
pub use plan::design_trials;
pub use request::PlanRequest;
