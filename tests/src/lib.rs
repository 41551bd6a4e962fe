//! What the journeys and the accuracy tests share: the program, a server, the measured data.

pub mod binary;
pub mod esso_osaka;
pub mod fleet;
pub mod fuzzed;
pub mod hidden_effects;
pub mod planted_faults;
pub mod server;
pub mod shape;
pub mod shared;
pub mod synthetic;
pub mod truth;
pub mod undeclared_wind;
pub mod voyage;
pub mod worker;
