//! Revolutions of an upload in the browser where none are recorded, as `sistership import --ship`
//! states them. A current is a person's to state: a diagnosis finds one that is not.

use sistership_jobs::archive::parse_vessel;
use sistership_jobs::budget;
use sistership_jobs::stated_revolutions::state_revolutions;
use sistership_model::trial::Trial;
use sistership_web_support::drafts::UploadDraft;
use sistership_web_support::upload::TrialUpload;

use crate::app::App;
use crate::problem::Result;
use crate::upload::read_one;

/// Largest number of samples that are read for the estimates.
const MOST_SAMPLES: usize = 1_000_000;

/// States revolutions in the manifest of a draft; the form shows them for correction.
pub(super) async fn state_estimates(
    app: &App,
    draft: &UploadDraft,
    upload: TrialUpload,
) -> Result<()> {
    let mut trials = read_trials(app, &upload).await;
    if trials.is_empty() {
        return Ok(());
    }
    let mut proposal = draft.current_proposal();
    let ship = app.store().ships().get(&proposal.ship).await?;
    let (zoo, vessel) = (app.stored_laws().await?, parse_vessel(&ship.name, &ship.document)?);
    let estimate = move || {
        let manifest = &mut proposal.manifest;
        let listed = &mut manifest.manifest.trials;
        let note = state_revolutions(&zoo, Some(&vessel), listed, &mut trials);
        proposal.notes = note.into_iter().collect();
        proposal
    };
    draft.set_proposal(app.run_blocking(estimate).await?);
    Ok(())
}

/// Reads the trials of an upload that are accepted; none if they are too many for an estimate.
async fn read_trials(app: &App, upload: &TrialUpload) -> Vec<Trial> {
    let (mut trials, mut samples) = (Vec::new(), 0);
    for at in 0..upload.manifest.manifest.trials.len() {
        // A file with errors is listed on the page, and corrected there.
        let Ok(read) = read_one(upload, app, at).await else { continue };
        samples += read.trial.len();
        // Eight bytes for each sample of each channel, and of time.
        let bytes = 8 * read.trial.len() * (1 + read.trial.channels.len());
        if samples > MOST_SAMPLES || budget::reserve_for_request(bytes as u64).await.is_err() {
            return Vec::new();
        }
        trials.push(read.trial);
    }
    trials
}
