//! The end of a diagnosis: its report, and the one transaction that keeps what was found, the
//! version that comes of it, and the job. The champion never moves by itself.

use std::sync::Arc;

use serde_json::{Value, json};
use sistership_model::trial::Trial;
use sistership_model::version::sha256;
use sistership_store::{
    AliasMove, Diagnosis, Expect, Job, NewDiagnosed, NewReport, NewVersion, ReportHead, StoreError,
    VersionHead,
};

use super::outcome::{JobError, Result, failed};
use crate::app::App;
use sistership_pipeline::derive::Diagnosed;
use sistership_pipeline::fleet::Drift;
use sistership_pipeline::line::{CANDIDATE, Standing, step};
use sistership_report::{DiagnosisInput, Rendered, VersionLabel, render_diagnosis};

/// The kind of the reports, and the method of the versions.
const DIAGNOSIS: &str = "diagnosis";

/// A diagnosis that is to be kept.
struct Made<'a> {
    diagnosed: Arc<Diagnosed>,
    of: &'a VersionHead,
    trials: &'a [String],
    version: Option<NewVersion>,
}

/// Keeps a diagnosis; where it has found effects, the version with them becomes the candidate.
pub(super) async fn commit(
    app: &App,
    job: &Job,
    diagnosed: Diagnosed,
    of: &VersionHead,
    trials: &[String],
) -> Result<()> {
    let made =
        Made { version: version(&diagnosed, of)?, diagnosed: Arc::new(diagnosed), of, trials };
    for _ in 0..super::TRIES {
        let standing = Standing::of(app.store(), &of.model).await?;
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
        weights: document.model.branch.as_ref().map(|branch| branch.weights_sha256.clone()),
    }))
}

impl Made<'_> {
    async fn report(&self, app: &App, number: i64) -> Result<NewReport> {
        let label = |version: &NewVersion| {
            let sha256 = sha256(version.document.as_bytes());
            VersionLabel { ship: version.model.clone(), number, sha256 }
        };
        let (diagnosed, made) = (Arc::clone(&self.diagnosed), self.version.as_ref().map(label));
        let of = VersionLabel {
            ship: self.of.model.clone(),
            number: self.of.number,
            sha256: self.of.sha256.clone(),
        };
        let rendered = app.compute(move || render(&diagnosed, of, made)).await??;
        let document = serde_json::to_string(&rendered.json).map_err(failed)?;
        let (kind, ship, html) = (DIAGNOSIS.to_owned(), self.of.model.clone(), rendered.html);
        Ok(NewReport { version_id: None, ship, kind, document, html })
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
        let version = self.version.clone().map(|version| (version, moves));
        let drift = drift(app, &self.of.model).await;
        let diagnosis = Diagnosis { version, report, found: self.found()?, drift };
        let result =
            |version: Option<&VersionHead>, report: &ReportHead| self.result(version, report);
        app.store().commit_diagnosis(&job.id, job.fence, &diagnosis, result).await?;
        Ok(())
    }

    fn name(&self) -> String {
        format!("{}/{}", self.of.model, self.of.number)
    }

    fn effects(&self) -> Vec<&str> {
        self.diagnosed.diagnosis.effects.iter().map(|effect| effect.name.as_str()).collect()
    }

    fn verdict(&self) -> Value {
        json!(self.diagnosed.diagnosis.verdict)
    }

    fn found(&self) -> Result<NewDiagnosed> {
        Ok(NewDiagnosed {
            version_id: self.of.id.clone(),
            verdict: self.verdict().as_str().unwrap_or_default().to_owned(),
            effects: serde_json::to_string(&self.effects()).map_err(failed)?,
            trials: serde_json::to_string(self.trials).map_err(failed)?,
        })
    }

    fn result(&self, version: Option<&VersionHead>, report: &ReportHead) -> String {
        let diagnosis = &self.diagnosed.diagnosis;
        let mut result = json!({
            "diagnosed": self.name(), "verdict": self.verdict(), "effects": self.effects(),
            "report": report.id,
            "before": diagnosis.before, "after": diagnosis.after,
            "next_trial": diagnosis.next_trial,
        });
        if let Some(version) = version {
            result["model"] = json!(version.model);
            result["version"] = json!(version.number);
            result["sha256"] = json!(version.sha256);
            result["alias"] = json!(CANDIDATE);
        }
        result.to_string()
    }
}

/// How much more the champion leaves of new trials; a diagnosis is kept also where that cannot be
/// found out.
async fn drift(app: &App, ship: &str) -> Option<f64> {
    match Drift::of(app.archive(), ship).await {
        Ok(drift) => drift?.worst,
        Err(error) => {
            tracing::warn!(ship, %error, "drift could not be measured");
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
