//! CSV files of trials.

use sistership_trials::{TrialFile, check_source, read_trial};

/// A file that is accepted has as many samples as the check says, and none that is no number.
pub fn run(data: &[u8]) {
    let outcome = check_source(TrialFile::from_csv("fuzz.csv", data), &super::small());
    match read_trial(TrialFile::from_csv("fuzz.csv", data), &super::small()) {
        Ok(trial) => {
            assert!(
                outcome.is_accepted() && outcome.rows == trial.len(),
                "check and reading disagree"
            );
            super::holds(&trial);
        }
        Err(refusal) => {
            assert!(
                !outcome.is_accepted() && !refusal.findings.is_empty(),
                "a refusal without a reason"
            );
        }
    }
}
