//! Which ship is similar, and what its model says of another: similarity of ships, eligibility by
//! category and trend, the transfer of a source model to a ship's particulars, and the steering gear
//! that its trials show.

mod estimated;
pub mod estimates;
pub mod rolling;
pub mod similarity;
pub mod source;
pub mod steering;
pub mod transfer;
pub mod trend;
