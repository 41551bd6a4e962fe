//! Uploads read without storing anything.

use sistership_model::trial::Trial;
use sistership_trials::{CheckOutcome, Refusal, check_source, read_trial};
use sistership_web_support::upload::TrialUpload;

use super::memory::reserve_memory;
use crate::app::App;
use crate::problem::Result;

/// Reads every file without storing any, one after the other, and maps each result by `of`.
pub(crate) async fn read_each<T: Send + 'static>(
    upload: &TrialUpload,
    app: &App,
    of: impl Fn(usize, std::result::Result<Trial, Refusal>) -> T + Copy + Send + 'static,
) -> Result<Vec<T>> {
    let mut made = Vec::with_capacity(upload.manifest.manifest.trials.len());
    for (at, mut trial) in upload.trials().enumerate() {
        let share = reserve_memory(app, &mut trial).await?;
        let one = move || {
            let _share = share;
            let source = trial.open().map_err(|error| read_failure(&trial.name, &error));
            of(at, source.and_then(|source| read_trial(source, &trial.mapping)))
        };
        made.push(app.read_files(one).await?);
    }
    Ok(made)
}

/// Checks every file without storing any, one after the other.
pub(crate) async fn check_upload(upload: &TrialUpload, app: &App) -> Result<Vec<CheckOutcome>> {
    let mut outcomes = Vec::with_capacity(upload.manifest.manifest.trials.len());
    for mut trial in upload.trials() {
        let share = reserve_memory(app, &mut trial).await?;
        let one = move || {
            let _share = share;
            match trial.open() {
                Ok(source) => check_source(source, &trial.mapping),
                Err(error) => unreadable_file(&trial.name, &error),
            }
        };
        outcomes.push(app.read_files(one).await?);
    }
    Ok(outcomes)
}

fn unreadable_file(file: &str, error: &std::io::Error) -> CheckOutcome {
    let Refusal { file, findings } = read_failure(file, error);
    CheckOutcome { file, rows: 0, duration_s: 0.0, errors: findings, warnings: Vec::new() }
}

/// Refusal of a file that cannot be read.
pub(super) fn read_failure(file: &str, error: &std::io::Error) -> Refusal {
    let finding = sistership_model::trial::Finding {
        row: None,
        column: None,
        message: format!("cannot be read: {error}"),
    };
    Refusal { file: file.to_owned(), findings: vec![finding] }
}
