//! Uploads of trials: read and checked, and stored all together or not at all.

mod memory;
mod reading;
mod storing;

pub(crate) use reading::{check_upload, find_faults, read_each, read_one};
pub(crate) use sistership_web_support::spool::{SpooledFile, spool_stream, write_problem};
pub(crate) use sistership_web_support::upload::{RawQuery, TrialUpload};
pub(crate) use storing::{StoredTrial, store_upload};
