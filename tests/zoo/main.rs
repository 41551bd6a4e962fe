//! The zoo as data: every file of `models/` reads and sails, the schemas are current, and a new
//! law, vessel, coefficient set or effect is a new file and no Rust.

mod additions;
mod files;
mod hybrids;
mod page;
mod schemas;
