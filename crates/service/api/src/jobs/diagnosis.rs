//! The diagnosis job: its recipes, and their results.

use std::sync::Arc;

use sistership_model::version::SourceVersion;
use sistership_store::{Job, Version};

use super::commit_diagnosis::{TrialsDiagnosis, commit_diagnosis};
use super::outcome::{Result, permanent_failure};
use super::prepared::recipe_trials;
use super::progress::JobProgress;
use super::progress::report_progress;
use crate::app::App;
use sistership_jobs::condition::{EffectSequence, trials_to_diagnose};
use sistership_jobs::derive::run_diagnosis;
use sistership_jobs::memory::job_bytes;
use sistership_jobs::recipe::{DiagnosisKind, DiagnosisRecipe};
use sistership_jobs::request::DiagnosisJob;
use sistership_jobs::sorted_json::sort_keys;
use sistership_jobs::start::stored_library;
use sistership_model::version::code_revision;

/// Runs a diagnosis of the new trials and, if the job asks for it, another of these together with
/// earlier ones.
pub(super) async fn run_diagnosis_job(app: &App, job: &Job, progress: JobProgress) -> Result<()> {
    let asked: DiagnosisJob = serde_json::from_str(&job.request).map_err(permanent_failure)?;
    report_progress(&progress, 0.01, "reading the trials")?;
    let version = app.store().versions().get(&asked.ship, asked.number).await?;
    let whole = with_earlier(app, &asked, &version).await?;
    // The progress of each part is in proportion to its number of trials.
    let share = whole
        .as_ref()
        .map_or(0.0, |whole| whole.len() as f64 / (whole.len() + asked.trials.len()) as f64);
    let (begin, middle, end) = (0.05, 0.9 - 0.85 * share, 0.9);
    let sequence = EffectSequence::read(app.archive(), &version, &asked.trials).await?;
    let in_sequence = in_sequence(&asked, &sequence);
    let new =
        diagnose_part(app, &in_sequence, (&version, &asked.trials), (&progress, begin, middle))
            .await?;
    // Trials that were diagnosed before do not count again.
    let new = if sequence.is_new { new } else { without_history(new) };
    let (all, of_new) = match whole {
        None => (new, None),
        Some(whole) => {
            report_progress(&progress, middle, "diagnosing together with earlier trials")?;
            let all =
                diagnose_part(app, &asked, (&version, &whole), (&progress, middle, end)).await?;
            (without_history(all), Some(new))
        }
    };
    report_progress(&progress, 0.92, "writing the report")?;
    commit_diagnosis(app, job, &version.head, (all, of_new)).await
}

/// Diagnoses some trials; the progress goes from `begin` to `end`.
async fn diagnose_part(
    app: &App,
    asked: &DiagnosisJob,
    (version, trials): (&Version, &[String]),
    (progress, begin, end): (&JobProgress, f64, f64),
) -> Result<TrialsDiagnosis> {
    let recipe = diagnosis_recipe(app, asked, version, trials).await?;
    let step = progress.clone();
    let scaled =
        move |fraction: f64, what: &str| step.report(begin + (end - begin) * fraction, what);
    let diagnosed = run_diagnosis(app.archive(), recipe, Arc::new(scaled)).await?;
    Ok(TrialsDiagnosis::new(diagnosed, trials))
}

/// Request of a diagnosis that starts from what earlier trials say.
fn in_sequence(asked: &DiagnosisJob, sequence: &EffectSequence) -> DiagnosisJob {
    let mut asked = asked.clone();
    if asked.settings.earlier.is_none() {
        asked.settings.earlier.clone_from(&sequence.earlier);
    }
    asked
}

/// A diagnosis without information for the next one.
fn without_history(of: TrialsDiagnosis) -> TrialsDiagnosis {
    let mut diagnosed = of.diagnosed;
    if let Some(run) = Arc::get_mut(&mut diagnosed) {
        run.diagnosis.history = None;
    }
    TrialsDiagnosis { diagnosed, ..of }
}

/// Returns the trials of a job together with earlier ones, if these are to be diagnosed as well and
/// the memory allows it.
pub(super) async fn with_earlier(
    app: &App,
    asked: &DiagnosisJob,
    version: &Version,
) -> Result<Option<Vec<String>>> {
    if !asked.with_earlier {
        return Ok(None);
    }
    let law = app.stored_law(&version.head.law).await.ok();
    let most = app.limits().job_memory;
    let is_affordable = |samples: u64| job_bytes(samples, law.as_deref()) <= most;
    Ok(trials_to_diagnose(app.archive(), version, &asked.trials, &is_affordable).await?)
}

async fn diagnosis_recipe(
    app: &App,
    asked: &DiagnosisJob,
    version: &Version,
    ids: &[String],
) -> Result<DiagnosisRecipe> {
    let (ship, number, sha256) =
        (version.head.model.clone(), version.head.number, version.head.sha256.clone());
    let law = app.store().laws().get(&version.head.law).await?;
    Ok(DiagnosisRecipe {
        kind: DiagnosisKind::Diagnosis,
        diagnosed: SourceVersion { ship, number, sha256 },
        law_sha256: law.sha256,
        trials: recipe_trials(app, ids).await?,
        effects_sha256: stored_library(app.archive()).await?.sha256.clone(),
        settings: sort_keys(serde_json::to_value(&asked.settings).map_err(permanent_failure)?),
        code_revision: code_revision().to_owned(),
    })
}
