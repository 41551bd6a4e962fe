//! Uploads of trials: read and checked, and stored all together or not at all.

mod keep;
mod reading;
mod room;

pub(crate) use keep::{Kept, keep};
pub(crate) use reading::{checked, each};
pub(crate) use sistership_web_support::spool::{Spooled, hex, spool, unwritten};
pub(crate) use sistership_web_support::upload::{RawQuery, Upload};
