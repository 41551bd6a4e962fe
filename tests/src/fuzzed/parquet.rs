//! Parquet files: those of others, and the canonical samples.

use bytes::Bytes;
use sistership_trials::{TrialFile, read_trial, samples};

/// As for CSV; and canonical samples that are read are written to what is read to the same.
pub fn run(data: &[u8]) {
    let bytes = Bytes::copy_from_slice(data);
    if let Ok(trial) =
        read_trial(TrialFile::from_parquet("fuzz.parquet", bytes.clone()), &super::small())
    {
        super::holds(&trial);
    }
    let _ = samples::from_parquet(bytes);
}
