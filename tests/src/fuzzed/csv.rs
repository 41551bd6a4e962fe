//! CSV files of trials.

use sistership_trials::{Source, check, read_trial};

/// A file that is accepted has as many samples as the check says, and none that is no number.
pub fn run(data: &[u8]) {
    let outcome = check(Source::csv("fuzz.csv", data), &super::small());
    match read_trial(Source::csv("fuzz.csv", data), &super::small()) {
        Ok(trial) => {
            assert!(
                outcome.accepted() && outcome.rows == trial.len(),
                "check and reading disagree"
            );
            super::holds(&trial);
        }
        Err(refusal) => {
            assert!(
                !outcome.accepted() && !refusal.findings.is_empty(),
                "a refusal without a reason"
            );
        }
    }
}
