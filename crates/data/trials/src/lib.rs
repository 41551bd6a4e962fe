//! Reader of trial files: CSV, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, NMEA 0183 and 2000, and
//! MCAP. Units and signs are converted once, on input; the data are checked and optionally
//! smoothed.
//!
//! [`read_trial`] converts a [`TrialFile`] to a [`Trial`](sistership_model::trial::Trial) in
//! canonical units, or refuses it with findings that name row and column. [`read_in_full`] also
//! returns the variance of derived channels, and [`check_source`] returns the findings without the
//! samples. [`load_path`] reads a path of the command line, a manifest or a single file.
//! [`propose_manifest`] writes a manifest for files, and [`missing_channels`] lists the channels
//! that a law needs and a trial does not have. [`samples`] stores trials as Parquet and writes them
//! as CSV.

mod blanks;
mod bridge;
mod calendar;
mod cell_value;
mod cells;
mod checks;
mod clock;
mod column_formats;
mod column_parts;
mod column_reader;
mod column_set;
mod column_source;
pub mod containers;
mod convert;
mod csv_file;
mod currents;
mod decimals;
mod declarations;
mod demand;
mod derived;
mod derived_channel;
mod exclusion;
mod faults;
mod file_segments;
mod file_set;
mod findings;
mod ground;
mod guess;
mod kinematics;
mod layout;
mod limits;
mod load;
mod magic;
mod manifest;
mod manifest_file;
mod mapping;
mod metered;
mod names;
mod needs;
mod nmea_file;
mod nmea_sentence;
mod number;
mod open_dates;
mod outcome;
mod pairs;
mod parquet_cells;
mod parquet_file;
mod parquet_footer;
mod position;
mod preview;
mod propose;
mod read;
mod recording;
mod resolve;
mod row_sink;
mod rows;
pub mod samples;
mod sampling;
mod scan;
mod segment_tables;
pub mod segmentation;
mod series;
mod side_by_side;
mod smoother;
pub mod smoothing;
mod stamp;
mod stats;
mod stream;
mod table;
mod template;
#[cfg(test)]
mod testing;
mod text_decoder;
mod thruster_guess;
mod trial_file;
mod trial_rows;
mod units;
mod water;
mod workbook;
mod written_time;

pub use currents::{TrialCurrent, estimate_currents};
pub use declarations::{
    Antenna, Declarations, Derivable, GeographicPosition, Maximum, North, SensorFile,
};
pub use demand::{MemoryDemand, demand_of_trial, measuring_bytes};
pub use derived_channel::DerivedChannel;
pub use exclusion::{Exclusion, RowRanges};
pub use file_segments::FileSegment;
pub use guess::ColumnGuess;
pub use limits::FileLimits;
pub use load::{CleanedTrials, LoadedTrials, check_path, load_cleaned, load_path, split_path};
pub use manifest::read_manifest_file;
pub use manifest_file::ManifestFile;
pub use mapping::Mapping;
pub use needs::{MissingChannel, missing_channels};
pub use outcome::{CheckOutcome, Refusal, TrialReading};
pub use propose::{ManifestProposal, ProposalRequest, propose_files, propose_manifest};
pub use read::{check_source, find_source_faults, read_in_full, read_trial, read_with_rows};
pub use scan::{SteeringSample, scan_file};
pub use sistership_columns::{GivenColumn, Role};
pub use template::ImportTemplate;
pub use trial_file::TrialFile;
pub use trial_rows::TrialWithRows;
