//! Uploads of trials: read and checked, and stored all together or not at all.

mod keep;
mod reading;
mod room;

pub(crate) use keep::{StoredTrial, store_upload};
pub(crate) use reading::{check_upload, read_each};
pub(crate) use sistership_web_support::spool::{
    SpooledFile, hex_digits, spool_stream, write_problem,
};
pub(crate) use sistership_web_support::upload::{RawQuery, TrialUpload};
