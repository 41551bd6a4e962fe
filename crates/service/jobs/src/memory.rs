//! The memory that deriving takes, estimated beforehand.

use sistership_model::Law;

/// Bytes of a refinement or diagnosis for each sample of its trials: the linearised model, its
/// columns and their products, most of it while learning what the trials leave open. Measured with
/// the zoo's largest law: 944 MB above the program's own for the 135,120 samples of 34 trials of
/// the Esso Osaka (`--law low-speed --method trajectory`, decision 17).
pub const DERIVING: u64 = 7 << 10;
/// Terms of that law; what is held grows with their number.
const TERMS: u64 = 189;
/// Bytes of any job beside that: simulations, bands, the report.
const EVERY: u64 = 24 << 20;
/// Bytes of a sample: time and as many as eleven channels.
const SAMPLE: u64 = 96;
/// Bytes of a trial with so many samples.
pub fn trial_bytes(samples: i64) -> u64 {
    SAMPLE * u64::try_from(samples).unwrap_or(0)
}

/// Bytes of a job over so many samples, by a law where it is known.
#[must_use]
pub fn job_bytes(samples: u64, law: Option<&Law>) -> u64 {
    EVERY + DERIVING * samples * law.map_or(0, terms).max(TERMS) / TERMS
}

fn terms(law: &Law) -> u64 {
    let terms: usize = law.axes.values().map(|axis| axis.terms.len()).sum();
    (terms * (1 + law.submodels.len())) as u64
}
