//! The zoo as data: every file of `models/` reads and sails, the schemas are current, and a new law, vessel or
//! coefficient set is a new file and no Rust.

mod additions;
mod files;
mod schemas;
