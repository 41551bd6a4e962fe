//! The end of a diagnosis: its report, and the one transaction that keeps the findings, the
//! resulting version, and the job. The champion never moves by itself.

use std::sync::Arc;

use serde_json::{Value, json};
use sistership_model::trial::Trial;
use sistership_model::version::sha256_hex;
use sistership_store::{
    AliasMove, ExpectedRevision, Job, NewDiagnosis, NewDiagnosisRow, NewReport, NewVersion,
    PartDiagnosis, ReportHead, StoreError, VersionHead,
};

use super::outcome::{JobError, Result, permanent_failure};
use crate::app::App;
use sistership_jobs::aliases::{CANDIDATE, VersionHistory, server_move};
use sistership_jobs::condition::RecentDrift;
use sistership_jobs::derive::DiagnosisRun;
use sistership_jobs::fleet::Drift;
use sistership_report::{DiagnosisInput, RenderedReport, VersionLabel, render_diagnosis};

/// Kind of the reports, and method of the versions.
const DIAGNOSIS: &str = "diagnosis";

/// A diagnosis with the ids of its trials, in the order of the recipe.
pub(super) struct TrialsDiagnosis {
    pub diagnosed: Arc<DiagnosisRun>,
    pub trials: Vec<String>,
}

impl TrialsDiagnosis {
    pub fn new(diagnosed: DiagnosisRun, trials: &[String]) -> Self {
        Self { diagnosed: Arc::new(diagnosed), trials: trials.to_vec() }
    }
}

/// Diagnoses that are about to be kept.
struct PendingDiagnosis<'a> {
    of: &'a VersionHead,
    all: TrialsDiagnosis,
    of_new: Option<PartDiagnosis>,
    version: Option<NewVersion>,
    drift: Option<RecentDrift>,
}

/// Keeps a diagnosis, together with that of the new trials alone if it covers more; if it has found
/// missing effects, the version with them becomes the candidate.
pub(super) async fn commit_diagnosis(
    app: &App,
    job: &Job,
    of: &VersionHead,
    (all, of_new): (TrialsDiagnosis, Option<TrialsDiagnosis>),
) -> Result<()> {
    let part = match of_new {
        Some(part) => Some(part_diagnosis(app, of, &part).await?),
        None => None,
    };
    let version = new_version(&all.diagnosed, of)?;
    let made =
        PendingDiagnosis { of, all, of_new: part, version, drift: champion_drift(app, of).await };
    for _ in 0..super::TRIES {
        let standing = VersionHistory::read_current(app.store(), &of.model).await?;
        // The report names the number that the version is going to have.
        let report = made.version_report(app, standing.next).await?;
        match made.commit(app, job, &standing, report).await {
            // Another version has come in between; the report would name the wrong number.
            Err(JobError::Store(StoreError::PreconditionFailed { .. })) => {}
            other => return other,
        }
    }
    Err(permanent_failure("other versions of the ship were stored at the same time; retry the job"))
}

fn new_version(diagnosed: &DiagnosisRun, of: &VersionHead) -> Result<Option<NewVersion>> {
    let Some(document) = diagnosed.to_version().map_err(permanent_failure)? else {
        return Ok(None);
    };
    Ok(Some(NewVersion {
        model: of.model.clone(),
        parent: Some(of.id.clone()),
        law: document.model.law.clone(),
        method: DIAGNOSIS.to_owned(),
        document: document.to_canonical_json().map_err(permanent_failure)?,
        // Weights of a learned correction that the diagnosed model has stay part of the model.
        weights: document.model.branch.as_ref().map(|branch| branch.weights_sha256.clone()),
    }))
}

/// Returns the diagnosis of the new trials alone, which yields no version.
async fn part_diagnosis(
    app: &App,
    of: &VersionHead,
    part: &TrialsDiagnosis,
) -> Result<PartDiagnosis> {
    let report = render_report(app, of, &part.diagnosed, None).await?;
    Ok(PartDiagnosis { report, found: diagnosis_row(of, part, None)? })
}

async fn render_report(
    app: &App,
    of: &VersionHead,
    diagnosed: &Arc<DiagnosisRun>,
    made: Option<VersionLabel>,
) -> Result<NewReport> {
    let label =
        VersionLabel { ship: of.model.clone(), number: of.number, sha256: of.sha256.clone() };
    // The closure needs its own handle: rendering runs on a blocking thread.
    let diagnosed = Arc::clone(diagnosed);
    let rendered =
        app.run_blocking(move || render_diagnosis_report(&diagnosed, label, made)).await??;
    let document = serde_json::to_string(&rendered.json).map_err(permanent_failure)?;
    let (kind, ship, html) = (DIAGNOSIS.to_owned(), of.model.clone(), rendered.html);
    Ok(NewReport { version_id: None, ship, kind, document, html })
}

fn diagnosis_row(
    of: &VersionHead,
    part: &TrialsDiagnosis,
    drift: Option<&RecentDrift>,
) -> Result<NewDiagnosisRow> {
    Ok(NewDiagnosisRow {
        version_id: of.id.clone(),
        verdict: verdict_value(&part.diagnosed).as_str().unwrap_or_default().to_owned(),
        effects: serde_json::to_string(&effect_names(&part.diagnosed))
            .map_err(permanent_failure)?,
        trials: serde_json::to_string(&part.trials).map_err(permanent_failure)?,
        unexplained: serde_json::to_string(&unexplained_trials(part)).map_err(permanent_failure)?,
        drift: drift.map(serde_json::to_string).transpose().map_err(permanent_failure)?,
    })
}

fn verdict_value(diagnosed: &DiagnosisRun) -> Value {
    json!(diagnosed.diagnosis.verdict)
}

fn effect_names(diagnosed: &DiagnosisRun) -> Vec<&str> {
    diagnosed.diagnosis.effects.iter().map(|effect| effect.name.as_str()).collect()
}

/// Ids of the trials with unexplained segments.
fn unexplained_trials(part: &TrialsDiagnosis) -> Vec<&String> {
    let left = &part.diagnosed.diagnosis.unexplained;
    let is_left = |trial: &Trial| left.iter().any(|stretch| stretch.trial == trial.name);
    let trials = part.diagnosed.trials.iter().zip(&part.trials);
    trials.filter(|(trial, _)| is_left(trial)).map(|(_, id)| id).collect()
}

impl PendingDiagnosis<'_> {
    async fn version_report(&self, app: &App, number: i64) -> Result<NewReport> {
        let label = |version: &NewVersion| {
            let sha256 = sha256_hex(version.document.as_bytes());
            VersionLabel { ship: version.model.clone(), number, sha256 }
        };
        render_report(app, self.of, &self.all.diagnosed, self.version.as_ref().map(label)).await
    }

    async fn commit(
        &self,
        app: &App,
        job: &Job,
        standing: &VersionHistory,
        report: NewReport,
    ) -> Result<()> {
        let reason = format!("missing effects of {} added in job {}", self.version_name(), job.id);
        let moves: Vec<AliasMove> = vec![
            server_move(CANDIDATE, ExpectedRevision::Any, &reason),
            standing.move_latest(&reason),
        ];
        let diagnosis = NewDiagnosis {
            version: self.version.clone().map(|version| (version, moves)),
            report,
            found: diagnosis_row(self.of, &self.all, self.drift.as_ref())?,
            of_new: self.of_new.clone(),
            drift: self.drift.as_ref().map(|drift| drift.ratio),
        };
        let result =
            |version: Option<&VersionHead>, report: &ReportHead| self.job_result(version, report);
        app.store().commit_diagnosis(&job.id, job.fence, &diagnosis, result).await?;
        Ok(())
    }

    fn version_name(&self) -> String {
        format!("{}/{}", self.of.model, self.of.number)
    }

    fn job_result(&self, version: Option<&VersionHead>, report: &ReportHead) -> String {
        let diagnosis = &self.all.diagnosed.diagnosis;
        let mut result = json!({
            "diagnosed": self.version_name(),
            "verdict": verdict_value(&self.all.diagnosed), "effects": effect_names(&self.all.diagnosed),
            "report": report.id,
            "before": diagnosis.before, "after": diagnosis.after,
            "next_trial": diagnosis.next_trial,
        });
        // With two diagnoses the result names the trials of the larger and the verdict of the
        // smaller one.
        if let Some(of_new) = &self.of_new {
            result["trials"] = json!(self.all.trials);
            result["verdict_of_new"] = json!(of_new.found.verdict);
        }
        if let Some(version) = version {
            result["model"] = json!(version.model);
            result["version"] = json!(version.number);
            result["sha256"] = json!(version.sha256);
            result["alias"] = json!(CANDIDATE);
        }
        result.to_string()
    }
}

/// Returns the drift of the champion on new trials, if the champion is the version diagnosed. A
/// diagnosis is kept even if the drift cannot be computed.
async fn champion_drift(app: &App, of: &VersionHead) -> Option<RecentDrift> {
    match Drift::for_champion(app.archive(), &of.model).await {
        // The drift must be that of the version diagnosed: the champion may have moved meanwhile.
        Ok(drift) => drift.filter(|drift| drift.version == of.number)?.over_newest(),
        Err(error) => {
            tracing::warn!(ship = of.model, %error, "the drift of the model could not be computed");
            None
        }
    }
}

fn render_diagnosis_report(
    diagnosed: &DiagnosisRun,
    of: VersionLabel,
    made: Option<VersionLabel>,
) -> Result<RenderedReport> {
    let trials: Vec<&Trial> = diagnosed.trials.iter().collect();
    let DiagnosisRun { diagnosis, model, law, .. } = diagnosed;
    render_diagnosis(&DiagnosisInput { diagnosis, model, law, trials: &trials, of: Some(of), made })
        .map_err(permanent_failure)
}
