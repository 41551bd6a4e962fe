//! The end of a training: its weights become an object, and one transaction keeps version, aliases,
//! report and job. The champion never moves by itself.

use bytes::Bytes;
use serde_json::{Value, json};
use sistership_jobs::aliases::{CANDIDATE, VersionHistory, server_move};
use sistership_jobs::derive::DerivedVersion;
use sistership_learned::{BranchChoice, CorrectionEvaluation};
use sistership_model::branch::CorrectionDocument;
use sistership_model::version::sha256_hex;
use sistership_report::{BranchInput, VersionLabel, render_branch};
use sistership_store::{
    ExpectedRevision, Job, NewRefinement, NewReport, NewVersion, RefinementRows, StoreError,
    VersionHead,
};

use super::outcome::{JobError, Result, permanent_failure};
use crate::app::App;

/// Kind of the reports, and first word of the versions' method.
const BRANCH: &str = "branch";

/// A version that is about to be kept.
struct PendingVersion<'a> {
    version: NewVersion,
    weights: Bytes,
    of: &'a VersionHead,
    branch: CorrectionDocument,
    judgement: Option<CorrectionEvaluation>,
    result: Value,
}

/// Keeps a version with its weights, as candidate.
pub(super) async fn commit_training(
    app: &App,
    job: &Job,
    derived: DerivedVersion,
    of: &VersionHead,
    choice: Option<BranchChoice>,
) -> Result<()> {
    let made = PendingVersion::new(derived, of, choice)?;
    for _ in 0..super::TRIES {
        // In each attempt again: an object without a row may be collected as garbage.
        app.objects().put(made.weights.clone()).await?;
        let standing = VersionHistory::read_current(app.store(), &of.model).await?;
        match made.commit(app, job, &standing).await {
            // Another version has come in between, or the weights had existed without a row and
            // were removed as garbage.
            Err(JobError::Store(
                StoreError::PreconditionFailed { .. } | StoreError::NotFound { kind: "object", .. },
            )) => {}
            other => return other,
        }
    }
    Err(permanent_failure("other versions of the ship were stored at the same time; retry the job"))
}

/// Name of the method, such as `branch-kernel-ridge-parallel`.
fn method_name(branch: &CorrectionDocument) -> String {
    format!("{BRANCH}-{}-{}", branch.recipe.learner.name().replace(' ', "-"), branch.mode.name())
}

impl<'a> PendingVersion<'a> {
    fn new(
        derived: DerivedVersion,
        of: &'a VersionHead,
        choice: Option<BranchChoice>,
    ) -> Result<Self> {
        let missing = || permanent_failure("the recipe is not the recipe of a learned correction");
        let DerivedVersion { document, weights, .. } = derived;
        let branch = document.model.branch.clone().ok_or_else(missing)?;
        let judgement: Option<CorrectionEvaluation> =
            serde_json::from_value(document.report.clone()).map_err(permanent_failure)?;
        let mut result = json!({
            "foundation": format!("{}/{}", of.model, of.number),
            "branch": { "kind": branch.recipe.learner.name(), "mode": branch.mode.name(),
                "weights_sha256": branch.weights_sha256 },
            "judgement": judgement, "wins": judgement.as_ref().map(CorrectionEvaluation::is_better),
        });
        if let Some(choice) = choice {
            result["choice"] = json!(choice);
        }
        let version = NewVersion {
            model: of.model.clone(),
            parent: Some(of.id.clone()),
            law: document.model.law.clone(),
            method: method_name(&branch),
            document: document.to_canonical_json().map_err(permanent_failure)?,
            weights: Some(branch.weights_sha256.clone()),
        };
        let weights = weights.ok_or_else(missing)?;
        Ok(Self { version, weights, of, branch, judgement, result })
    }

    async fn commit(&self, app: &App, job: &Job, standing: &VersionHistory) -> Result<()> {
        let reason = format!(
            "learned correction of {}/{}, trained in job {}",
            self.of.model, self.of.number, job.id
        );
        let moves = vec![
            server_move(CANDIDATE, ExpectedRevision::Any, &reason),
            standing.move_latest(&reason),
        ];
        let report = Some(self.render_report(standing.next)?);
        let refinement = NewRefinement { version: self.version.clone(), moves, report, next: None };
        let result = |kept: &RefinementRows<'_>| self.job_result(kept);
        let (store, objects) = (app.store(), Some(app.objects()));
        store.commit_refinement(objects, (&job.id, job.fence), &refinement, result).await?;
        Ok(())
    }

    fn render_report(&self, number: i64) -> Result<NewReport> {
        let sha256 = sha256_hex(self.version.document.as_bytes());
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
        .map_err(permanent_failure)?;
        Ok(NewReport {
            version_id: None,
            ship: self.version.model.clone(),
            kind: BRANCH.to_owned(),
            document: serde_json::to_string(&rendered.json).map_err(permanent_failure)?,
            html: rendered.html,
        })
    }

    fn job_result(&self, RefinementRows { version, report, .. }: &RefinementRows<'_>) -> String {
        let mut result = self.result.clone();
        result["model"] = json!(version.model);
        result["version"] = json!(version.number);
        result["sha256"] = json!(version.sha256);
        result["alias"] = json!(CANDIDATE);
        result["report"] = json!(report.map(|report| &report.id));
        result.to_string()
    }
}
