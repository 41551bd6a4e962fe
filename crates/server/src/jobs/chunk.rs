//! A chunk of a bulk refinement: its ships are gathered, refined on all cores, and kept together with the end of the job.

use rayon::prelude::*;
use serde_json::{Value, json};
use sistership_estimate::refine::RefineError;
use sistership_fleet::bulk::BulkRefinement;
use sistership_fleet::statistics::Frame;
use sistership_store::{AliasMove, Expect, Job, NewOutcome, NewVersion, StoreError};

use super::outcome::{Result, failed};
use super::progress::Progress;
use super::progress::tell;
use crate::app::App;
use sistership_pipeline::derive::DeriveError;
use sistership_pipeline::fleet::{Chunk, Frames, Gathered, Loaded, Order, refined, statistics_of, trials_of};
use sistership_pipeline::inputs::Inputs;
use sistership_pipeline::line::{CANDIDATE, CHAMPION, Standing, step};
use sistership_pipeline::version::VersionDocument;

/// How the versions are made.
const METHOD: &str = "statistics";
/// Coefficients that move by less than this share of themselves have not moved.
const UNMOVED: f64 = 1e-9;

/// A ship of the chunk, ready to be refined, or why not.
struct Member {
    ship: String,
    standing: Standing,
    champion: Option<i64>,
    parent: Option<String>,
    gathered: std::result::Result<Gathered, String>,
}

/// A ship of the chunk, refined, or why not.
type Outcome = std::result::Result<(BulkRefinement, VersionDocument), String>;

/// Does a chunk.
pub(super) async fn run(app: &App, job: &Job, progress: Progress) -> Result<()> {
    let chunk: Chunk = serde_json::from_str(&job.request).map_err(failed)?;
    let bulk = app.store().bulks().get(&chunk.bulk).await?;
    let order: Order = serde_json::from_str(&bulk.request).map_err(failed)?;
    let loaded = std::sync::Arc::new(Loaded::of(&Inputs::new(app.archive()), order).await?);
    for _ in 0..super::TRIES {
        let members = members(app, &loaded, &chunk, &progress).await?;
        tell(&progress, 0.5, "refining")?;
        let work = std::sync::Arc::clone(&loaded);
        let done = app.compute(move || members.into_par_iter().map(|member| refine(&work, member)).collect::<Vec<_>>()).await?;
        tell(&progress, 0.9, "keeping the versions")?;
        let outcomes = done.into_iter().map(|(member, outcome)| kept(&loaded, &bulk.id, member, outcome));
        let outcomes: Vec<NewOutcome> = outcomes.collect::<Result<_>>()?;
        let result = json!({ "bulk_refinement": bulk.id, "ships": outcomes.len() }).to_string();
        match app.store().bulks().commit(&bulk.id, (&job.id, job.fence), &outcomes, &result).await {
            // Another version of one of the ships has come in between.
            Err(StoreError::PreconditionFailed { .. }) => {}
            other => return Ok(other.map(drop)?),
        }
    }
    Err(failed("other versions of the ships kept coming in between; retry the job"))
}

async fn members(app: &App, loaded: &Loaded, chunk: &Chunk, progress: &Progress) -> Result<Vec<Member>> {
    let mut members = Vec::with_capacity(chunk.ships.len());
    for (index, ship) in chunk.ships.iter().enumerate() {
        tell(progress, 0.5 * index as f64 / chunk.ships.len() as f64, &format!("statistics of {ship}"))?;
        members.push(member(app, loaded, ship).await?);
    }
    Ok(members)
}

async fn member(app: &App, loaded: &Loaded, ship: &str) -> Result<Member> {
    let standing = Standing::of(app.store(), ship).await?;
    let mut member = Member { ship: ship.to_owned(), standing, champion: None, parent: None, gathered: Err(String::new()) };
    match gathered(app, loaded, &mut member).await {
        Ok(gathered) => member.gathered = Ok(gathered),
        // The database, and not the ship.
        Err(error @ (DeriveError::Broken(_) | DeriveError::Refine(RefineError::Cancelled))) => return Err(error.into()),
        Err(DeriveError::Store(error)) if !matches!(error, StoreError::NotFound { .. } | StoreError::Objects(_)) => {
            return Err(error.into());
        }
        Err(error) => member.gathered = Err(error.to_string()),
    }
    Ok(member)
}

async fn gathered(app: &App, loaded: &Loaded, member: &mut Member) -> std::result::Result<Gathered, DeriveError> {
    let order = &loaded.order;
    let archive = app.archive();
    let frames = Frames { archive, foundation: &order.foundation, model: &loaded.foundation, law: &loaded.law };
    let framed = frames.of(&member.ship, order.start).await?;
    (member.champion, member.parent) = (framed.champion, framed.version_id);
    let trials = trials_of(archive, &member.ship).await?;
    if trials.is_empty() {
        return Err(DeriveError::Lost("she has no trials".to_owned()));
    }
    let frame = Frame::new(&framed.model, &loaded.law, &order.law_sha256, order.settings.difference_s)?;
    let statistics = statistics_of(archive, &frame, &trials).await?;
    let recipe = order.recipe(framed.from, framed.ship_sha256, trials);
    Ok(Gathered { model: framed.model, statistics, recipe })
}

fn refine(loaded: &Loaded, mut member: Member) -> (Member, Outcome) {
    let gathered = std::mem::replace(&mut member.gathered, Err(String::new()));
    let outcome = gathered.and_then(|gathered| refined(loaded, &member.ship, gathered).map_err(|error| error.to_string()));
    (member, outcome)
}

/// What becomes of a ship: champion where the rule lets her model be one, else candidate.
fn kept(loaded: &Loaded, bulk: &str, member: Member, outcome: Outcome) -> Result<NewOutcome> {
    let ship = member.ship.clone();
    let (refinement, document) = match outcome {
        Ok(done) => done,
        Err(reason) => {
            let document = json!({ "reason": reason }).to_string();
            return Ok(NewOutcome { ship, outcome: "refused".into(), version: None, worst_change: None, document });
        }
    };
    let worst = refinement.worst_change();
    let summary = summary(&refinement);
    if unmoved(&refinement) {
        let outcome = "unchanged".to_owned();
        return Ok(NewOutcome { ship, outcome, version: None, worst_change: Some(worst), document: summary.to_string() });
    }
    let champion = loaded.order.rule.no_worse_than.is_some_and(|share| worst <= share);
    let reason = format!("refined with the family {} in bulk refinement {bulk}", loaded.order.family);
    let version = NewVersion {
        model: ship.clone(),
        parent: member.parent.clone(),
        law: document.model.law.clone(),
        method: METHOD.to_owned(),
        document: document.canonical().map_err(failed)?,
    };
    let outcome = if champion { CHAMPION } else { CANDIDATE }.to_owned();
    Ok(NewOutcome {
        ship,
        outcome,
        version: Some((version, member.moves(champion, &reason))),
        worst_change: Some(worst),
        document: summary.to_string(),
    })
}

impl Member {
    fn moves(&self, champion: bool, reason: &str) -> Vec<AliasMove> {
        let expect = self.champion.map_or(Expect::Absent, Expect::Revision);
        let named = if champion { step(CHAMPION, expect, reason) } else { step(CANDIDATE, Expect::Any, reason) };
        vec![named, self.standing.follow(reason)]
    }
}

fn unmoved(refinement: &BulkRefinement) -> bool {
    refinement.coefficients.iter().all(|c| (c.refined - c.before).abs() <= UNMOVED * c.before.abs())
}

/// Before and after, without the coefficients, which the version holds.
fn summary(refinement: &BulkRefinement) -> Value {
    let BulkRefinement { axes, pulled, before, after, trials, .. } = refinement;
    json!({ "axes": axes, "pulled": pulled, "before": before, "after": after, "trials": trials })
}
