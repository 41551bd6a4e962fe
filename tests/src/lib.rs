//! What the journeys and the accuracy tests share: finding the measured data, reading it, comparing with it.

pub mod esso_osaka;
pub mod shared;
