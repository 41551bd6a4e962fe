//! Data sets: what a call is given, and what it is judged on.

pub mod esso_osaka;
mod set;
pub mod sr108;
pub mod synthetic;

pub use set::DataSet;
