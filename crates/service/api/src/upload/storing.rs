//! From uploaded files to stored trials.

use std::io::BufWriter;

use bytes::Bytes;
use sistership_store::{
    InsertOutcome, Job, NewJob, NewTrial, ObjectStorage, StoreError, Trial, is_out_of_space,
};
use sistership_trials::samples::{self, SamplesError};
use sistership_trials::{ManifestFile, Refusal, TrialReading, read_in_full};
use tempfile::NamedTempFile;

use super::memory::run_with_memory;
use super::reading::read_failure;
use crate::app::App;
use crate::jobs::{DIAGNOSIS_JOB_KIND, DiagnosisJob, is_small};
use crate::problem::{Problem, Result};
use crate::rights::check_ship_role;
use sistership_auth::Role;
use sistership_jobs::aliases::{CHAMPION, find_alias};
use sistership_jobs::budget;
use sistership_web_support::spool::{SpoolFolder, temporary_file};
use sistership_web_support::upload::{TrialUpload, UploadedTrial};

/// Number of attempts to store samples again that were removed before their rows were written.
const TRIES: usize = 3;

/// A stored trial, with the information whether it was new.
pub(crate) type StoredTrial = InsertOutcome<Trial>;

/// A trial that has passed every check.
struct AcceptedTrial {
    new: NewTrial,
    /// Its samples as they will be stored, on disk, so that the trials of one upload are not in
    /// memory together.
    samples: NamedTempFile,
}

/// Stores the trials of an upload: all of them, or none if one is refused. The job that diagnoses
/// the ship's champion on the new ones is queued with them.
pub(crate) async fn store_upload(
    app: &App,
    upload: TrialUpload,
) -> Result<(Vec<StoredTrial>, Option<Job>)> {
    // The ship may be in the body, so that the router could not check the role.
    let (ship, diagnose) = (upload.ship().to_owned(), upload.diagnose);
    check_ship_role(app.store(), Role::Engineer, &ship).await?;
    match app.store().ships().get(&ship).await {
        Err(StoreError::NotFound { .. }) => return Err(unknown_ship(&ship)),
        other => drop(other?),
    }
    let accepted = read_upload(&upload, app).await?;
    let champion = if diagnose { champion_number(app, &ship).await? } else { None };
    let job = |kept: &[StoredTrial]| champion.and_then(|number| follow_up_job(&ship, number, kept));
    for _ in 0..TRIES {
        let rows = trial_rows(&accepted, put_samples(app.objects(), &accepted).await?);
        match app.store().trials().insert_all_and_enqueue(&rows, app.objects(), job).await {
            // The objects had existed without a row and were removed as garbage between the two
            // steps.
            Err(StoreError::NotFound { kind: "object", .. }) => {}
            other => return Ok(other?),
        }
    }
    Err(Problem::internal(
        "samples of an upload were removed from the object store while it was \
                           stored; send it again",
    ))
}

/// Returns the number of the ship's champion.
async fn champion_number(app: &App, ship: &str) -> Result<Option<i64>> {
    Ok(find_alias(app.store(), ship, CHAMPION).await?.map(|champion| champion.version_number))
}

/// Returns the job that diagnoses a champion on the new trials, and on these together with earlier
/// ones.
fn follow_up_job(ship: &str, number: i64, kept: &[StoredTrial]) -> Option<NewJob> {
    let new: Vec<&Trial> = kept.iter().filter(|trial| trial.new).map(|trial| &trial.row).collect();
    let trials: Vec<String> = new.iter().map(|trial| trial.id.clone()).collect();
    let (ship, settings) = (ship.to_owned(), Default::default());
    let asked = DiagnosisJob { ship: ship.clone(), number, trials, with_earlier: true, settings };
    // An upload without a new trial needs no diagnosis.
    let request = serde_json::to_string(&asked).ok().filter(|_| !asked.trials.is_empty())?;
    let small = is_small(new.into_iter());
    Some(NewJob { kind: DIAGNOSIS_JOB_KIND.to_owned(), ship: Some(ship), request, small })
}

fn unknown_ship(ship: &str) -> Problem {
    Problem::invalid(
        "ship",
        format!(
            "there is no ship `{ship}`; create it with POST /v1/ships first, or correct the \
                 name"
        ),
    )
}

/// Reads every file, one after the other.
///
/// # Errors
/// Returns the refusals of all files together.
async fn read_upload(upload: &TrialUpload, app: &App) -> Result<Vec<AcceptedTrial>> {
    let (mut accepted, mut refused) = (Vec::new(), Vec::new());
    for trial in upload.trials() {
        let inner = app.clone();
        // The memory is held until the samples are on disk.
        let read = move |trial: &UploadedTrial| read_arrived(trial, inner.spool());
        match run_with_memory(app, trial, read).await?? {
            Ok(trial) => accepted.push(trial),
            Err(refusal) => refused.push(refusal),
        }
    }
    if refused.is_empty() { Ok(accepted) } else { Err(Vec::<Refusal>::into(refused)) }
}

/// Reads a trial, and writes its samples to a temporary file.
fn read_arrived(
    arrived: &UploadedTrial,
    spool: &SpoolFolder,
) -> Result<std::result::Result<AcceptedTrial, Refusal>> {
    let source = arrived.open().map_err(|error| read_failure(&arrived.name, &error));
    match source.and_then(|source| read_in_full(source, &arrived.mapping)) {
        Ok(TrialReading { trial, origin, .. }) => {
            // The samples are in metres: their place on the earth is kept with the manifest.
            let mut only = arrived.manifest.clone();
            only.declarations.origin = origin;
            AcceptedTrial::new(&only, &trial, spool).map(Ok)
        }
        Err(refusal) => Ok(Err(refusal)),
    }
}

impl AcceptedTrial {
    fn new(
        only: &ManifestFile,
        trial: &sistership_model::trial::Trial,
        spool: &SpoolFolder,
    ) -> Result<Self> {
        let samples = temporary_file(spool)?;
        samples::write_parquet(BufWriter::new(samples.as_file()), trial).map_err(write_problem)?;
        let new = NewTrial {
            ship: only.manifest.ship.clone(),
            sha256: String::new(),
            name: trial.name.clone(),
            manifest: to_json(only)?,
            conventions: to_json(&only.manifest.conventions)?,
            manoeuvre: trial.manoeuvre.clone(),
            sample_rows: i64::try_from(trial.len()).map_err(Problem::internal)?,
            duration_s: trial.duration_s(),
            warnings: to_json(&trial.warnings)?,
            object_key: String::new(),
        };
        Ok(Self { new, samples })
    }
}

/// Maps an error of writing samples: the lack of space is among its causes.
fn write_problem(error: SamplesError) -> Problem {
    let first: &(dyn std::error::Error + 'static) = &error;
    let mut causes = std::iter::successors(Some(first), |cause| cause.source());
    match causes
        .find_map(|cause| cause.downcast_ref::<std::io::Error>())
        .is_some_and(is_out_of_space)
    {
        true => Problem::no_room(format!("an upload cannot be written: {error}")),
        false => Problem::internal(error),
    }
}

fn to_json(value: &impl serde::Serialize) -> Result<String> {
    serde_json::to_string(value).map_err(Problem::internal)
}

/// Stores the samples; their rows are written afterwards, so that a row always has its samples.
async fn put_samples(objects: &ObjectStorage, accepted: &[AcceptedTrial]) -> Result<Vec<String>> {
    let mut keys = Vec::with_capacity(accepted.len());
    for trial in accepted {
        let size = trial.samples.as_file().metadata().map_err(Problem::internal)?.len();
        // The memory of one file at a time.
        let _share = budget::reserve_share(size).await?;
        let bytes = tokio::fs::read(trial.samples.path()).await.map_err(Problem::internal)?;
        keys.push(objects.put(Bytes::from(bytes)).await?);
    }
    Ok(keys)
}

fn trial_rows(accepted: &[AcceptedTrial], keys: Vec<String>) -> Vec<NewTrial> {
    let row = |(trial, key): (&AcceptedTrial, String)| NewTrial {
        sha256: key.clone(),
        object_key: key,
        ..trial.new.clone()
    };
    accepted.iter().zip(keys).map(row).collect()
}
