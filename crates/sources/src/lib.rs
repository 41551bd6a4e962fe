//! Which ship is similar, and what its model says of another: similarity of ships, eligibility by
//! category and trend, and the transfer of a source model to a ship's particulars.

mod estimated;
pub mod similarity;
pub mod source;
pub mod transfer;
pub mod trend;
