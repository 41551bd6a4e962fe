//! The end of a diagnosis: its report, and the one transaction that keeps the findings, the
//! resulting version, and the job. The champion never moves by itself.

use std::sync::Arc;

use serde_json::{Value, json};
use sistership_model::trial::Trial;
use sistership_model::version::sha256;
use sistership_store::{
    AliasMove, Diagnosis, Expect, Job, NewDiagnosed, NewReport, NewVersion, PartDiagnosis,
    ReportHead, StoreError, VersionHead,
};

use super::outcome::{JobError, Result, failed};
use crate::app::App;
use sistership_jobs::condition::RecentDrift;
use sistership_jobs::derive::Diagnosed;
use sistership_jobs::fleet::Drift;
use sistership_jobs::line::{CANDIDATE, Standing, step};
use sistership_report::{DiagnosisInput, Rendered, VersionLabel, render_diagnosis};

/// Kind of the reports, and method of the versions.
const DIAGNOSIS: &str = "diagnosis";

/// A diagnosis with the ids of its trials, in the order of the recipe.
pub(super) struct TrialsDiagnosis {
    pub diagnosed: Arc<Diagnosed>,
    pub trials: Vec<String>,
}

impl TrialsDiagnosis {
    pub fn new(diagnosed: Diagnosed, trials: &[String]) -> Self {
        Self { diagnosed: Arc::new(diagnosed), trials: trials.to_vec() }
    }
}

/// Diagnoses that are about to be kept.
struct Made<'a> {
    of: &'a VersionHead,
    all: TrialsDiagnosis,
    of_new: Option<PartDiagnosis>,
    version: Option<NewVersion>,
    drift: Option<RecentDrift>,
}

/// Keeps a diagnosis, together with that of the new trials alone if it covers more; if it has found
/// missing effects, the version with them becomes the candidate.
pub(super) async fn commit(
    app: &App,
    job: &Job,
    of: &VersionHead,
    (all, of_new): (TrialsDiagnosis, Option<TrialsDiagnosis>),
) -> Result<()> {
    let part = match of_new {
        Some(part) => Some(of_part(app, of, &part).await?),
        None => None,
    };
    let version = version(&all.diagnosed, of)?;
    let made = Made { of, all, of_new: part, version, drift: drift(app, of).await };
    for _ in 0..super::TRIES {
        let standing = Standing::of(app.store(), &of.model).await?;
        // The report names the number that the version is going to have.
        let report = made.report(app, standing.next).await?;
        match made.keep(app, job, &standing, report).await {
            // Another version has come in between; the report would name the wrong number.
            Err(JobError::Store(StoreError::PreconditionFailed { .. })) => {}
            other => return other,
        }
    }
    Err(failed("other versions of the ship kept coming in between; retry the job"))
}

fn version(diagnosed: &Diagnosed, of: &VersionHead) -> Result<Option<NewVersion>> {
    let Some(document) = diagnosed.document().map_err(failed)? else { return Ok(None) };
    Ok(Some(NewVersion {
        model: of.model.clone(),
        parent: Some(of.id.clone()),
        law: document.model.law.clone(),
        method: DIAGNOSIS.to_owned(),
        document: document.canonical().map_err(failed)?,
        // Weights of a learned correction that the diagnosed model has stay part of the model.
        weights: document.model.branch.as_ref().map(|branch| branch.weights_sha256.clone()),
    }))
}

/// Returns the diagnosis of the new trials alone, which yields no version.
async fn of_part(app: &App, of: &VersionHead, part: &TrialsDiagnosis) -> Result<PartDiagnosis> {
    let report = report(app, of, &part.diagnosed, None).await?;
    Ok(PartDiagnosis { report, found: found(of, part, None)? })
}

async fn report(
    app: &App,
    of: &VersionHead,
    diagnosed: &Arc<Diagnosed>,
    made: Option<VersionLabel>,
) -> Result<NewReport> {
    let label =
        VersionLabel { ship: of.model.clone(), number: of.number, sha256: of.sha256.clone() };
    // The closure needs its own handle: rendering runs on a blocking thread.
    let diagnosed = Arc::clone(diagnosed);
    let rendered = app.compute(move || render(&diagnosed, label, made)).await??;
    let document = serde_json::to_string(&rendered.json).map_err(failed)?;
    let (kind, ship, html) = (DIAGNOSIS.to_owned(), of.model.clone(), rendered.html);
    Ok(NewReport { version_id: None, ship, kind, document, html })
}

fn found(
    of: &VersionHead,
    part: &TrialsDiagnosis,
    drift: Option<&RecentDrift>,
) -> Result<NewDiagnosed> {
    Ok(NewDiagnosed {
        version_id: of.id.clone(),
        verdict: verdict(&part.diagnosed).as_str().unwrap_or_default().to_owned(),
        effects: serde_json::to_string(&effects(&part.diagnosed)).map_err(failed)?,
        trials: serde_json::to_string(&part.trials).map_err(failed)?,
        unexplained: serde_json::to_string(&unexplained(part)).map_err(failed)?,
        drift: drift.map(serde_json::to_string).transpose().map_err(failed)?,
    })
}

fn verdict(diagnosed: &Diagnosed) -> Value {
    json!(diagnosed.diagnosis.verdict)
}

fn effects(diagnosed: &Diagnosed) -> Vec<&str> {
    diagnosed.diagnosis.effects.iter().map(|effect| effect.name.as_str()).collect()
}

/// Ids of the trials with unexplained segments.
fn unexplained(part: &TrialsDiagnosis) -> Vec<&String> {
    let left = &part.diagnosed.diagnosis.unexplained;
    let is_left = |trial: &Trial| left.iter().any(|stretch| stretch.trial == trial.name);
    let trials = part.diagnosed.trials.iter().zip(&part.trials);
    trials.filter(|(trial, _)| is_left(trial)).map(|(_, id)| id).collect()
}

impl Made<'_> {
    async fn report(&self, app: &App, number: i64) -> Result<NewReport> {
        let label = |version: &NewVersion| {
            let sha256 = sha256(version.document.as_bytes());
            VersionLabel { ship: version.model.clone(), number, sha256 }
        };
        report(app, self.of, &self.all.diagnosed, self.version.as_ref().map(label)).await
    }

    async fn keep(
        &self,
        app: &App,
        job: &Job,
        standing: &Standing,
        report: NewReport,
    ) -> Result<()> {
        let reason = format!("effects found missing from {} in job {}", self.name(), job.id);
        let moves: Vec<AliasMove> =
            vec![step(CANDIDATE, Expect::Any, &reason), standing.follow(&reason)];
        let diagnosis = Diagnosis {
            version: self.version.clone().map(|version| (version, moves)),
            report,
            found: found(self.of, &self.all, self.drift.as_ref())?,
            of_new: self.of_new.clone(),
            drift: self.drift.as_ref().map(|drift| drift.ratio),
        };
        let result =
            |version: Option<&VersionHead>, report: &ReportHead| self.result(version, report);
        app.store().commit_diagnosis(&job.id, job.fence, &diagnosis, result).await?;
        Ok(())
    }

    fn name(&self) -> String {
        format!("{}/{}", self.of.model, self.of.number)
    }

    fn result(&self, version: Option<&VersionHead>, report: &ReportHead) -> String {
        let diagnosis = &self.all.diagnosed.diagnosis;
        let mut result = json!({
            "diagnosed": self.name(),
            "verdict": verdict(&self.all.diagnosed), "effects": effects(&self.all.diagnosed),
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
async fn drift(app: &App, of: &VersionHead) -> Option<RecentDrift> {
    match Drift::of(app.archive(), &of.model).await {
        // The drift must be that of the version diagnosed: the champion may have moved meanwhile.
        Ok(drift) => drift.filter(|drift| drift.version == of.number)?.recent(),
        Err(error) => {
            tracing::warn!(ship = of.model, %error, "drift could not be measured");
            None
        }
    }
}

fn render(diagnosed: &Diagnosed, of: VersionLabel, made: Option<VersionLabel>) -> Result<Rendered> {
    let trials: Vec<&Trial> = diagnosed.trials.iter().collect();
    let Diagnosed { diagnosis, model, law, .. } = diagnosed;
    render_diagnosis(&DiagnosisInput { diagnosis, model, law, trials: &trials, of: Some(of), made })
        .map_err(failed)
}
