//! The end of a refinement: its report, and the one transaction that keeps version, aliases, report
//! and job.

use std::sync::Arc;

use serde_json::{Value, json};
use sistership_learned::{BranchKind, BranchSettings};
use sistership_model::trial::Trial;
use sistership_model::version::sha256;
use sistership_model_selection::Ladder;
use sistership_priors::source::Similarity;
use sistership_store::{
    Expect, Job, Kept, NewJob, NewReport, NewVersion, Refinement, StoreError, Version,
};

use super::outcome::{JobError, Result, failed};
use super::prepared::Prepared;
use crate::app::App;
use sistership_jobs::derive::{Derived, Refined};
use sistership_jobs::line::{CANDIDATE, CHAMPION, Standing, step};
use sistership_jobs::promotion::{Comparison, against_champion};
use sistership_jobs::request::{BRANCH, BranchJob};
use sistership_report::{self as report, Rendered, VersionLabel};

/// A version that is about to be kept, with the inputs of its report.
struct Made {
    version: NewVersion,
    refined: Arc<Refined>,
    similarity: Option<Arc<Similarity>>,
    ladder: Option<Arc<Ladder>>,
    comparison: Option<Comparison>,
    /// The selected learned correction, with the ids of the trials to train it on.
    branch: Option<(BranchKind, Vec<String>)>,
    result: Value,
}

/// Keeps the derived version: as champion if the ship has none, otherwise as candidate.
pub(super) async fn commit(
    app: &App,
    job: &Job,
    derived: Derived,
    (prepared, trials): (Prepared, &[String]),
) -> Result<()> {
    // The comparison with the champion is computed once, outside of the loop: it takes simulations
    // and does not depend on the version's number.
    let hashes = derived.document.recipe.trials().iter().map(|t| t.sha256.clone()).collect();
    let made = Made::new(derived, prepared, trials)?;
    let refined = Arc::clone(&made.refined);
    let comparison = against_champion(app.archive(), &made.version.model, refined, hashes).await?;
    let made = Made { comparison, ..made };
    for _ in 0..super::TRIES {
        let standing = Standing::of(app.store(), &made.version.model).await?;
        let report = made.report(app, standing.next).await?;
        match made.keep(app, job, &standing, report).await {
            // Another version has come in between; the report would name the wrong number.
            Err(JobError::Store(StoreError::PreconditionFailed { .. })) => {}
            other => return other,
        }
    }
    Err(failed("other versions of the ship kept coming in between; retry the job"))
}

impl Made {
    fn new(derived: Derived, prepared: Prepared, trials: &[String]) -> Result<Self> {
        let Derived { document, refined, .. } = derived;
        let named = |source: &Version| format!("{}/{}", source.head.model, source.head.number);
        let source = prepared.start.source.as_ref().map(named);
        let refined = refined.ok_or_else(|| failed("the recipe is not that of a refinement"))?;
        let version = NewVersion {
            model: document.ship.clone(),
            parent: prepared.start.source.map(|source| source.head.id),
            law: document.model.law.clone(),
            method: refined.refinement.method.clone(),
            document: document.canonical().map_err(failed)?,
            weights: None,
        };
        // The ranking and the selection of the source model are part of the result.
        let ranking = prepared.start.similarity.as_ref().map(|similarity| &similarity.ranking);
        let from = refined.refinement.settings.origin(source.as_deref()).to_owned();
        let mut result = json!({ "source": source, "from": from, "held_out": refined.refinement.held_out,
            "ranking": ranking });
        if let Some(ladder) = &prepared.start.ladder {
            result["ladder"] = serde_json::to_value(ladder).map_err(failed)?;
        }
        Ok(Self {
            version,
            branch: branch(prepared.start.ladder.as_ref(), &refined, trials),
            refined: Arc::new(refined),
            similarity: prepared.start.similarity.map(Arc::new),
            ladder: prepared.start.ladder.map(Arc::new),
            comparison: None,
            result,
        })
    }

    async fn report(&self, app: &App, number: i64) -> Result<NewReport> {
        let sha256 = sha256(self.version.document.as_bytes());
        let label = VersionLabel { ship: self.version.model.clone(), number, sha256 };
        let (refined, similarity) = (Arc::clone(&self.refined), self.similarity.clone());
        let ladder = self.ladder.clone();
        // The closure needs its own handles: rendering runs on a blocking thread.
        let how = move || render(&refined, (similarity.as_deref(), ladder.as_deref()), label);
        let rendered = app.compute(how).await??;
        let document = serde_json::to_string(&rendered.json).map_err(failed)?;
        Ok(NewReport {
            version_id: None,
            ship: self.version.model.clone(),
            kind: "refinement".into(),
            document,
            html: rendered.html,
        })
    }

    async fn keep(
        &self,
        app: &App,
        job: &Job,
        standing: &Standing,
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
            _ if !standing.champion && !standing.second_person => Some((CHAMPION, Expect::Absent)),
            Some(comparison) if comparison.is_worse() => None,
            _ => Some((CANDIDATE, Expect::Any)),
        };
        let own = alias.map(|(alias, expect)| step(alias, expect, &reason));
        let moves = own.into_iter().chain([standing.follow(&reason)]).collect();
        let alias = alias.map(|(alias, _)| alias);
        let (report, next) = (Some(report), self.next(standing.next)?);
        let refinement = Refinement { version: self.version.clone(), moves, report, next };
        let result = |kept: &Kept<'_>| self.result(kept, alias);
        app.store().commit_refinement(None, (&job.id, job.fence), &refinement, result).await?;
        Ok(())
    }

    /// Returns the job that trains the learned correction on the version of this number.
    fn next(&self, number: i64) -> Result<Option<NewJob>> {
        let Some((kind, trials)) = self.branch.clone() else { return Ok(None) };
        let ship = self.version.model.clone();
        let settings = BranchSettings::default().of(kind);
        let asked = BranchJob { ship: ship.clone(), number, trials, settings };
        let request = serde_json::to_string(&asked).map_err(failed)?;
        Ok(Some(NewJob { kind: BRANCH.to_owned(), ship: Some(ship), request }))
    }

    fn result(&self, Kept { version, report, next }: &Kept<'_>, alias: Option<&str>) -> String {
        let mut result = self.result.clone();
        result["model"] = json!(version.model);
        result["version"] = json!(version.number);
        result["sha256"] = json!(version.sha256);
        result["alias"] = json!(alias);
        result["comparison"] = json!(self.comparison.as_ref().map(Comparison::words));
        result["report"] = json!(report.map(|report| &report.id));
        if let Some(next) = next {
            result["branch_job"] = json!(next.id);
        }
        result.to_string()
    }
}

/// Returns the selected kind of learned correction, and the ids of the trials that the refinement
/// was fitted to.
fn branch(
    ladder: Option<&Ladder>,
    refined: &Refined,
    trials: &[String],
) -> Option<(BranchKind, Vec<String>)> {
    let kind = ladder?.branch.as_ref()?.taken?;
    let held_out = &refined.refinement.settings.held_out;
    // Recipe and request list the trials in the same order.
    let named = refined.ingredients.trials.iter().zip(trials);
    let fitted = named.filter(|(trial, _)| !held_out.contains(&trial.name));
    Some((kind, fitted.map(|(_, id)| id.clone()).collect()))
}

fn render(
    refined: &Refined,
    (similarity, ladder): (Option<&Similarity>, Option<&Ladder>),
    version: VersionLabel,
) -> Result<Rendered> {
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
    report::render_refinement(&input).map_err(failed)
}
