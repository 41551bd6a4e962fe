//! Trial files in: CSV and Parquet, units and signs converted once at the door, checked, optionally smoothed.
//!
//! [`read_trial`] turns a [`Source`] into a [`Trial`](sistership_model::trial::Trial) in canonical units, or refuses it
//! with findings that name row and column; [`check`] tells the same without the samples. [`load_path`] reads what a
//! command line names: a manifest or a single file. [`samples`] keeps trials as Parquet and writes them as CSV.

mod cells;
mod checks;
mod convert;
mod csv_file;
mod demand;
mod findings;
mod limits;
mod load;
mod manifest;
mod mapping;
mod metered;
mod names;
mod number;
mod outcome;
mod pages;
mod parquet_file;
mod parquet_format;
mod read;
mod recording;
mod resolve;
mod rows;
pub mod samples;
pub mod smoothing;
mod source;
mod stats;
mod table;
#[cfg(test)]
mod testing;
mod units;

pub use demand::{Demand, demand, measuring};
pub use limits::Limits;
pub use load::{Loaded, check_path, load_path};
pub use manifest::read_manifest;
pub use mapping::Mapping;
pub use outcome::{CheckOutcome, Refusal};
pub use read::{check, read_trial};
pub use source::Source;
