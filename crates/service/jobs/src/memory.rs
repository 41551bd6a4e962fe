//! Estimates of the memory that jobs need.

use sistership_model::Law;

/// Bytes of a refinement or diagnosis for each sample of its trials: the linearised model, its
/// columns and their products, most of it during the calibration of the uncertainty. Measured with
/// the zoo's largest law: 944 MB above the program's own for the 135,120 samples of 34 trials of
/// the Esso Osaka (`--law low-speed --method trajectory`, decision 17).
pub const BYTES_PER_SAMPLE: u64 = 7 << 10;
/// Number of terms of that law; the memory grows with the number of terms.
const MEASURED_TERMS: u64 = 189;
/// Bytes of any job in addition: simulations, bands, the report.
const BASE_BYTES: u64 = 24 << 20;
/// Bytes of a sample: time and up to eleven channels.
const TRIAL_SAMPLE_BYTES: u64 = 96;
/// Returns the memory of a trial with this number of samples, bytes.
pub fn trial_bytes(samples: i64) -> u64 {
    TRIAL_SAMPLE_BYTES * u64::try_from(samples).unwrap_or(0)
}

/// Returns the memory of a job over this number of samples, bytes, by its law if that is known.
#[must_use]
pub fn job_bytes(samples: u64, law: Option<&Law>) -> u64 {
    // Linear in samples and terms; smaller laws count as the measured one, to be on the safe side.
    BASE_BYTES
        + BYTES_PER_SAMPLE * samples * law.map_or(0, count_terms).max(MEASURED_TERMS)
            / MEASURED_TERMS
}

fn count_terms(law: &Law) -> u64 {
    let terms: usize = law.axes.values().map(|axis| axis.terms.len()).sum();
    (terms * (1 + law.submodels.len())) as u64
}
