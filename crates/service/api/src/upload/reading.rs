//! Uploads read without storing anything.

use sistership_trials::{
    CheckOutcome, Exclusion, Refusal, TrialWithRows, check_source, find_source_faults,
    read_with_rows,
};
use sistership_web_support::upload::{TrialUpload, UploadedTrial};

use super::memory::run_with_memory;
use crate::app::App;
use crate::problem::{Problem, Result};

/// Reads every file without storing any, one after the other, and maps each result by `of`.
pub(crate) async fn read_each<T: Send + 'static>(
    upload: &TrialUpload,
    app: &App,
    of: impl Fn(usize, std::result::Result<TrialWithRows, Refusal>) -> T + Clone + Send + 'static,
) -> Result<Vec<T>> {
    let mut made = Vec::with_capacity(upload.manifest.manifest.trials.len());
    for (at, trial) in upload.trials().enumerate() {
        let of = of.clone();
        made.push(run_with_memory(app, trial, move |trial| of(at, read_trial_rows(trial))).await?);
    }
    Ok(made)
}

/// Reads one of the files.
///
/// # Errors
/// Returns an error if the file is refused.
pub(crate) async fn read_one(upload: &TrialUpload, app: &App, at: usize) -> Result<TrialWithRows> {
    let trial = upload.trials().nth(at);
    let trial = trial.ok_or_else(|| Problem::invalid("file", "is not one of this upload"))?;
    run_with_memory(app, trial, read_trial_rows).await?.map_err(|refused| vec![refused].into())
}

/// Returns faults of the values of all files that the manifest does not exclude yet; none of a file
/// that cannot be opened.
pub(crate) async fn find_faults(upload: &TrialUpload, app: &App) -> Result<Vec<Exclusion>> {
    let mut found = Vec::new();
    for (trial, listed) in upload.trials().zip(&upload.manifest.manifest.trials) {
        let faults = run_with_memory(app, trial, |trial| match trial.open() {
            Ok(source) => find_source_faults(source, &trial.mapping),
            Err(_) => Vec::new(),
        });
        let of_file = |fault| Exclusion { file: listed.file.clone(), ..fault };
        found.extend(faults.await?.into_iter().map(of_file));
    }
    Ok(found)
}

fn read_trial_rows(trial: &UploadedTrial) -> std::result::Result<TrialWithRows, Refusal> {
    let source = trial.open().map_err(|error| read_failure(&trial.name, &error))?;
    read_with_rows(source, &trial.mapping)
}

/// Checks every file without storing any, one after the other.
pub(crate) async fn check_upload(upload: &TrialUpload, app: &App) -> Result<Vec<CheckOutcome>> {
    let mut outcomes = Vec::with_capacity(upload.manifest.manifest.trials.len());
    for trial in upload.trials() {
        let check = |trial: &UploadedTrial| match trial.open() {
            Ok(source) => check_source(source, &trial.mapping),
            Err(error) => unreadable_file(&trial.name, &error),
        };
        outcomes.push(run_with_memory(app, trial, check).await?);
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
