//! The end of a refinement: its report, and the one transaction that keeps version, aliases, report
//! and job.

use std::sync::Arc;

use serde_json::{Value, json};
use sistership_learned::{BranchKind, BranchSettings};
use sistership_model::trial::Trial;
use sistership_model::version::sha256_hex;
use sistership_model_selection::SelectionReport;
use sistership_priors::source::SimilarityRanking;
use sistership_store::{
    ExpectedRevision, Job, NewJob, NewRefinement, NewReport, NewVersion, RefinementRows,
    StoreError, Version,
};

use super::outcome::{JobError, Result, permanent_failure};
use super::prepared::PreparedRefinement;
use crate::app::App;
use sistership_jobs::aliases::{CANDIDATE, CHAMPION, VersionHistory, server_move};
use sistership_jobs::derive::{DerivedVersion, RefinementRun};
use sistership_jobs::promotion::{ChampionComparison, compare_with_champion};
use sistership_jobs::request::{BRANCH_JOB_KIND, BranchJob};
use sistership_report::{self as report, RenderedReport, VersionLabel};

/// A version that is about to be kept, with the inputs of its report.
struct PendingVersion {
    version: NewVersion,
    refined: Arc<RefinementRun>,
    similarity: Option<Arc<SimilarityRanking>>,
    ladder: Option<Arc<SelectionReport>>,
    comparison: Option<ChampionComparison>,
    /// The selected learned correction, with the ids of the trials to train it on.
    branch: Option<(BranchKind, Vec<String>)>,
    result: Value,
}

/// Keeps the derived version: as champion if the ship has none, otherwise as candidate.
pub(super) async fn commit_refinement(
    app: &App,
    job: &Job,
    derived: DerivedVersion,
    (prepared, trials): (PreparedRefinement, &[String]),
) -> Result<()> {
    // The comparison with the champion is computed once, outside of the loop: it takes simulations
    // and does not depend on the version's number.
    let hashes = derived.document.recipe.trials().iter().map(|t| t.sha256.clone()).collect();
    let made = PendingVersion::new(derived, prepared, trials)?;
    let refined = Arc::clone(&made.refined);
    let comparison =
        compare_with_champion(app.archive(), &made.version.model, refined, hashes).await?;
    let made = PendingVersion { comparison, ..made };
    for _ in 0..super::TRIES {
        let standing = VersionHistory::read_current(app.store(), &made.version.model).await?;
        let report = made.render_report(app, standing.next).await?;
        match made.commit(app, job, &standing, report).await {
            // Another version has come in between; the report would name the wrong number.
            Err(JobError::Store(StoreError::PreconditionFailed { .. })) => {}
            other => return other,
        }
    }
    Err(permanent_failure("other versions of the ship were stored at the same time; retry the job"))
}

impl PendingVersion {
    fn new(
        derived: DerivedVersion,
        prepared: PreparedRefinement,
        trials: &[String],
    ) -> Result<Self> {
        let DerivedVersion { document, refined, .. } = derived;
        let named = |source: &Version| format!("{}/{}", source.head.model, source.head.number);
        let source = prepared.start.source.as_ref().map(named);
        let refined = refined
            .ok_or_else(|| permanent_failure("the recipe is not the recipe of a refinement"))?;
        let version = NewVersion {
            model: document.ship.clone(),
            parent: prepared.start.source.map(|source| source.head.id),
            law: document.model.law.clone(),
            method: refined.refinement.method.clone(),
            document: document.to_canonical_json().map_err(permanent_failure)?,
            weights: None,
        };
        // The ranking and the selection of the source model are part of the result.
        let ranking = prepared.start.similarity.as_ref().map(|similarity| &similarity.ranking);
        let from = refined.refinement.settings.prior_origin(source.as_deref()).to_owned();
        let mut result = json!({ "source": source, "from": from, "held_out": refined.refinement.held_out,
            "ranking": ranking });
        if let Some(ladder) = &prepared.start.ladder {
            result["ladder"] = serde_json::to_value(ladder).map_err(permanent_failure)?;
        }
        Ok(Self {
            version,
            branch: selected_branch(prepared.start.ladder.as_ref(), &refined, trials),
            refined: Arc::new(refined),
            similarity: prepared.start.similarity.map(Arc::new),
            ladder: prepared.start.ladder.map(Arc::new),
            comparison: None,
            result,
        })
    }

    async fn render_report(&self, app: &App, number: i64) -> Result<NewReport> {
        let sha256 = sha256_hex(self.version.document.as_bytes());
        let label = VersionLabel { ship: self.version.model.clone(), number, sha256 };
        let (refined, similarity) = (Arc::clone(&self.refined), self.similarity.clone());
        let ladder = self.ladder.clone();
        // The closure needs its own handles: rendering runs on a blocking thread.
        let how = move || {
            render_refinement_report(&refined, (similarity.as_deref(), ladder.as_deref()), label)
        };
        let rendered = app.run_blocking(how).await??;
        let document = serde_json::to_string(&rendered.json).map_err(permanent_failure)?;
        Ok(NewReport {
            version_id: None,
            ship: self.version.model.clone(),
            kind: "refinement".into(),
            document,
            html: rendered.html,
        })
    }

    async fn commit(
        &self,
        app: &App,
        job: &Job,
        standing: &VersionHistory,
        report: NewReport,
    ) -> Result<()> {
        let reason = format!(
            "refined from {} in job {}",
            self.result["from"].as_str().unwrap_or_default(),
            job.id
        );
        // A version that is worse than the champion, in a comparison that does not favour the
        // champion, does not become candidate. Only a ship without champion gets one without a
        // person.
        let alias = match &self.comparison {
            _ if !standing.champion && !standing.second_person => {
                Some((CHAMPION, ExpectedRevision::Absent))
            }
            Some(comparison) if comparison.is_worse() => None,
            _ => Some((CANDIDATE, ExpectedRevision::Any)),
        };
        let own = alias.map(|(alias, expect)| server_move(alias, expect, &reason));
        let moves = own.into_iter().chain([standing.move_latest(&reason)]).collect();
        let alias = alias.map(|(alias, _)| alias);
        let (report, next) = (Some(report), self.training_job(standing.next)?);
        let refinement = NewRefinement { version: self.version.clone(), moves, report, next };
        let result = |kept: &RefinementRows<'_>| self.job_result(kept, alias);
        app.store().commit_refinement(None, (&job.id, job.fence), &refinement, result).await?;
        Ok(())
    }

    /// Returns the job that trains the learned correction on the version of this number.
    fn training_job(&self, number: i64) -> Result<Option<NewJob>> {
        let Some((kind, trials)) = self.branch.clone() else { return Ok(None) };
        let ship = self.version.model.clone();
        let settings = BranchSettings::default().with_kind(kind);
        let asked = BranchJob { ship: ship.clone(), number, trials, settings };
        let request = serde_json::to_string(&asked).map_err(permanent_failure)?;
        Ok(Some(NewJob {
            kind: BRANCH_JOB_KIND.to_owned(),
            ship: Some(ship),
            request,
            small: false,
        }))
    }

    fn job_result(
        &self,
        RefinementRows { version, report, next }: &RefinementRows<'_>,
        alias: Option<&str>,
    ) -> String {
        let mut result = self.result.clone();
        result["model"] = json!(version.model);
        result["version"] = json!(version.number);
        result["sha256"] = json!(version.sha256);
        result["alias"] = json!(alias);
        result["comparison"] = json!(self.comparison.as_ref().map(ChampionComparison::describe));
        result["report"] = json!(report.map(|report| &report.id));
        if let Some(next) = next {
            result["branch_job"] = json!(next.id);
        }
        result.to_string()
    }
}

/// Returns the selected kind of learned correction, and the ids of the trials that the refinement
/// was fitted to.
fn selected_branch(
    ladder: Option<&SelectionReport>,
    refined: &RefinementRun,
    trials: &[String],
) -> Option<(BranchKind, Vec<String>)> {
    let kind = ladder?.branch.as_ref()?.taken?;
    let held_out = &refined.refinement.settings.held_out;
    // Recipe and request list the trials in the same order.
    let named = refined.ingredients.trials.iter().zip(trials);
    let fitted = named.filter(|(trial, _)| !held_out.contains(&trial.name));
    Some((kind, fitted.map(|(_, id)| id.clone()).collect()))
}

fn render_refinement_report(
    refined: &RefinementRun,
    (similarity, ladder): (Option<&SimilarityRanking>, Option<&SelectionReport>),
    version: VersionLabel,
) -> Result<RenderedReport> {
    let trials: Vec<&Trial> = refined.ingredients.trials.iter().collect();
    let input = report::RefinementInput {
        refinement: &refined.refinement,
        law: &refined.ingredients.law,
        vessel: &refined.ingredients.target,
        trials: &trials,
        similarity,
        ladder,
        version: Some(version),
    };
    report::render_refinement(&input).map_err(permanent_failure)
}
