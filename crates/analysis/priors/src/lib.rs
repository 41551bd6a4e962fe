//! Priors from other ships: similarity of ships, eligibility by category and trend, the transfer of
//! a source model to a ship's particulars, and the steering gear by the ship's trials.

pub mod engine_response;
mod estimated;
pub mod estimates;
pub mod revolutions;
pub mod rolling;
pub mod similarity;
pub mod source;
pub mod steering;
pub mod transfer;
pub mod trend;
