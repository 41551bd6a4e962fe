//! Jobs of Sistership: derivation and verification of versions, calibration, search for ships,
//! bundles, and maintenance of an archive. Servers, workers and the command line share them.

pub mod aliases;
pub mod archive;
pub mod budget;
pub mod bundle;
pub mod catalogue;
pub mod champions;
pub mod comparison;
pub mod condition;
pub mod derive;
pub mod environment;
pub mod error;
pub mod example;
pub mod fleet;
pub mod input;
pub mod inputs;
pub mod leases;
pub mod library;
pub mod memory;
pub mod particulars_change;
pub mod predictions;
pub mod promotion;
pub mod publish;
mod published_ships;
pub mod recipe;
pub mod request;
pub mod schema;
pub mod search;
pub mod seed;
mod ship_trials;
pub mod sorted_json;
pub mod start;
pub mod stated_revolutions;
#[cfg(test)]
mod test_rows;
#[cfg(test)]
mod testing;
pub mod training;
pub mod upkeep;
pub mod validation;
pub mod verify;
pub mod version;
pub mod version_export;
pub mod webhooks;

pub use archive::Archive;
