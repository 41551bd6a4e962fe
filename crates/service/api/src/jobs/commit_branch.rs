//! The end of a training: its weights become an object, and one transaction keeps version, aliases,
//! report and job. The champion never moves by itself.

use bytes::Bytes;
use serde_json::{Value, json};
use sistership_jobs::derive::Derived;
use sistership_jobs::line::{CANDIDATE, Standing, step};
use sistership_learned::{BranchChoice, Judgement};
use sistership_model::branch::Branch;
use sistership_model::version::sha256;
use sistership_report::{BranchInput, VersionLabel, render_branch};
use sistership_store::{
    Expect, Job, Kept, NewReport, NewVersion, Refinement, StoreError, VersionHead,
};

use super::outcome::{JobError, Result, failed};
use crate::app::App;

/// Kind of the reports, and first word of the versions' method.
const BRANCH: &str = "branch";

/// A version that is about to be kept.
struct Made<'a> {
    version: NewVersion,
    weights: Bytes,
    of: &'a VersionHead,
    branch: Branch,
    judgement: Option<Judgement>,
    result: Value,
}

/// Keeps a version with its weights, as candidate.
pub(super) async fn commit(
    app: &App,
    job: &Job,
    derived: Derived,
    of: &VersionHead,
    choice: Option<BranchChoice>,
) -> Result<()> {
    let made = Made::new(derived, of, choice)?;
    for _ in 0..super::TRIES {
        // In each attempt again: an object without a row may be collected as garbage.
        app.objects().put(made.weights.clone()).await?;
        let standing = Standing::of(app.store(), &of.model).await?;
        match made.keep(app, job, &standing).await {
            // Another version has come in between, or the weights had existed without a row and
            // were removed as garbage.
            Err(JobError::Store(
                StoreError::PreconditionFailed { .. } | StoreError::NotFound { kind: "object", .. },
            )) => {}
            other => return other,
        }
    }
    Err(failed("other versions of the ship kept coming in between; retry the job"))
}

/// Name of the method, such as `branch-kernel-ridge-parallel`.
fn method(branch: &Branch) -> String {
    format!("{BRANCH}-{}-{}", branch.recipe.learner.name().replace(' ', "-"), branch.mode.name())
}

impl<'a> Made<'a> {
    fn new(derived: Derived, of: &'a VersionHead, choice: Option<BranchChoice>) -> Result<Self> {
        let missing = || failed("the recipe is not that of a learned branch");
        let Derived { document, weights, .. } = derived;
        let branch = document.model.branch.clone().ok_or_else(missing)?;
        let judgement: Option<Judgement> =
            serde_json::from_value(document.report.clone()).map_err(failed)?;
        let mut result = json!({
            "foundation": format!("{}/{}", of.model, of.number),
            "branch": { "kind": branch.recipe.learner.name(), "mode": branch.mode.name(),
                "weights_sha256": branch.weights_sha256 },
            "judgement": judgement, "wins": judgement.as_ref().map(Judgement::wins),
        });
        if let Some(choice) = choice {
            result["choice"] = json!(choice);
        }
        let version = NewVersion {
            model: of.model.clone(),
            parent: Some(of.id.clone()),
            law: document.model.law.clone(),
            method: method(&branch),
            document: document.canonical().map_err(failed)?,
            weights: Some(branch.weights_sha256.clone()),
        };
        let weights = weights.ok_or_else(missing)?;
        Ok(Self { version, weights, of, branch, judgement, result })
    }

    async fn keep(&self, app: &App, job: &Job, standing: &Standing) -> Result<()> {
        let reason =
            format!("trained beside {}/{} in job {}", self.of.model, self.of.number, job.id);
        let moves = vec![step(CANDIDATE, Expect::Any, &reason), standing.follow(&reason)];
        let report = Some(self.report(standing.next)?);
        let refinement = Refinement { version: self.version.clone(), moves, report, next: None };
        let result = |kept: &Kept<'_>| self.result(kept);
        let (store, objects) = (app.store(), Some(app.objects()));
        store.commit_refinement(objects, (&job.id, job.fence), &refinement, result).await?;
        Ok(())
    }

    fn report(&self, number: i64) -> Result<NewReport> {
        let sha256 = sha256(self.version.document.as_bytes());
        let label = |head: &VersionHead| VersionLabel {
            ship: head.model.clone(),
            number: head.number,
            sha256: head.sha256.clone(),
        };
        let rendered = render_branch(&BranchInput {
            branch: &self.branch,
            judgement: self.judgement.as_ref(),
            of: label(self.of),
            made: VersionLabel { ship: self.version.model.clone(), number, sha256 },
        })
        .map_err(failed)?;
        Ok(NewReport {
            version_id: None,
            ship: self.version.model.clone(),
            kind: BRANCH.to_owned(),
            document: serde_json::to_string(&rendered.json).map_err(failed)?,
            html: rendered.html,
        })
    }

    fn result(&self, Kept { version, report, .. }: &Kept<'_>) -> String {
        let mut result = self.result.clone();
        result["model"] = json!(version.model);
        result["version"] = json!(version.number);
        result["sha256"] = json!(version.sha256);
        result["alias"] = json!(CANDIDATE);
        result["report"] = json!(report.map(|report| &report.id));
        result.to_string()
    }
}
