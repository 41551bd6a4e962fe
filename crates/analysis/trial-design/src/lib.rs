//! Which trials to sail: the set of manoeuvres, speeds and headings that narrows the bands of the
//! IMO criteria most in a given time.
//!
//! A trial tells of the model's coefficients what the filter of the diagnosis would learn from it
//! (`sistership_diagnosis::ExpectedInformation`). With a normal posterior of covariance `R R'` and
//! coefficients `R z`, the trials of a plan leave `z` the covariance `(I + sum_i R' F_i R)^-1`; a
//! figure that changes by `g` with `z` then has the variance `g' (I + sum_i R' F_i R)^-1 g`. Chosen
//! is the plan that makes the mean logarithm of the figures' deviations least: a compound of
//! c-optimal designs, in which metres and degrees need no weights, for the logarithm of a product
//! knows no units (Atkinson and Donev 1992, Optimum experimental designs, chapters 9 to 11; Ljung
//! 1999, System identification, 2nd edition, chapter 13; Chaloner and Verdinelli 1995, Statistical
//! Science 10, 273-304, for designs by a posterior). It is found by adding whatever gains most a
//! minute and then exchanging (Fedorov 1972, Theory of optimal experiments, chapter 3).

mod candidates;
mod course;
mod design;
mod error;
mod expected;
mod instruments;
mod outcome;
mod plan;
mod request;
mod said;
mod search;
mod setting;
mod targets;
mod thresholds;
mod unknowns;

pub use error::PlanError;
pub use instruments::Instruments;
pub use outcome::{ExpectedBand, Plan, PlannedTrial, StandardProgramme};
pub use plan::plan;
pub use request::PlanRequest;
