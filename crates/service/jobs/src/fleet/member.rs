//! Member of a bulk refinement: loading, refinement and outcome.

use serde_json::{Value, json};
use sistership_fleet::bulk::BulkRefinement;
use sistership_fleet::statistics::Frame;
use sistership_identification::refine::RefineError;
use sistership_store::{AliasMove, Expect, NewOutcome, NewVersion, StoreError};

use super::frame::Frames;
use super::kept::statistics_of;
use super::learned::trials_of;
use super::order::Loaded;
use super::refined::{Gathered, refined};
use crate::archive::Archive;
use crate::error::DeriveError;
use crate::line::{CANDIDATE, CHAMPION, Standing, step};
use crate::version::VersionDocument;

type Result<T> = std::result::Result<T, DeriveError>;

/// Method name of the versions.
const METHOD: &str = "statistics";
/// Relative change below which a coefficient counts as unchanged.
const UNMOVED: f64 = 1e-9;

/// Ship of the chunk, ready to be refined, or the reason why it cannot be.
pub struct Member {
    ship: String,
    standing: Standing,
    champion: Option<i64>,
    parent: Option<String>,
    /// True if the champion has effects or a learned correction, which are not refined.
    is_reduced: bool,
    gathered: std::result::Result<Gathered, String>,
}

/// Refinement of a ship of the chunk, or the reason why there is none.
pub type Outcome = std::result::Result<(BulkRefinement, VersionDocument), String>;

/// Loads the inputs of the refinement of a member.
///
/// # Errors
/// Returns an error of the database or of the program; an error of the ship is part of the result.
pub async fn member(archive: &Archive, loaded: &Loaded, ship: &str) -> Result<Member> {
    let standing = Standing::of(&archive.store, ship).await?;
    let mut member = Member {
        ship: ship.to_owned(),
        standing,
        champion: None,
        parent: None,
        is_reduced: false,
        gathered: Err(String::new()),
    };
    match gathered(archive, loaded, &mut member).await {
        Ok(gathered) => member.gathered = Ok(gathered),
        // Faults of the database or of the program end the job; those of a ship are its outcome.
        Err(error @ (DeriveError::Broken(_) | DeriveError::Refine(RefineError::Cancelled))) => {
            return Err(error);
        }
        Err(DeriveError::Store(error))
            if !matches!(error, StoreError::NotFound { .. } | StoreError::Objects(_)) =>
        {
            return Err(error.into());
        }
        Err(error) => member.gathered = Err(error.to_string()),
    }
    Ok(member)
}

async fn gathered(archive: &Archive, loaded: &Loaded, member: &mut Member) -> Result<Gathered> {
    let order = &loaded.order;
    let frames = Frames {
        archive,
        foundation: &order.foundation,
        model: &loaded.foundation,
        law: &loaded.law,
    };
    let framed = frames.of(&member.ship, order.start).await?;
    (member.champion, member.parent) = (framed.champion, framed.version_id);
    member.is_reduced = framed.is_reduced;
    let trials = trials_of(archive, &member.ship).await?;
    if trials.is_empty() {
        return Err(DeriveError::Lost("it has no trials".to_owned()));
    }
    let frame =
        Frame::new(&framed.model, &loaded.law, &order.law_sha256, order.settings.difference_s)?;
    let statistics = statistics_of(archive, &frame, &trials).await?;
    let recipe = order.recipe(framed.from, framed.ship_sha256, trials);
    Ok(Gathered { model: framed.model, statistics, recipe })
}

/// Refines a member, or returns the reason why that is not possible.
pub fn refine(loaded: &Loaded, mut member: Member) -> (Member, Outcome) {
    // The inputs are large and are moved out; the rest of the member is needed for its outcome.
    let gathered = std::mem::replace(&mut member.gathered, Err(String::new()));
    let outcome = gathered.and_then(|gathered| {
        refined(loaded, &member.ship, gathered).map_err(|error| error.to_string())
    });
    (member, outcome)
}

/// Returns the outcome for a ship: champion if the rule allows it for its model, else candidate.
///
/// # Errors
/// Returns an error if a document cannot be written.
pub fn kept(loaded: &Loaded, bulk: &str, member: Member, outcome: Outcome) -> Result<NewOutcome> {
    let ship = member.ship.clone();
    let (refinement, document) = match outcome {
        Ok(done) => done,
        Err(reason) => {
            let document = json!({ "reason": reason }).to_string();
            return Ok(NewOutcome {
                ship,
                outcome: "refused".into(),
                version: None,
                worst_change: None,
                document,
            });
        }
    };
    let worst = refinement.worst_change();
    let summary = summary(&refinement);
    // No new version if the trials do not change the model: its history would only grow.
    if unmoved(&refinement) {
        let outcome = "unchanged".to_owned();
        return Ok(NewOutcome {
            ship,
            outcome,
            version: None,
            worst_change: Some(worst),
            document: summary.to_string(),
        });
    }
    // A model refined without the champion's effects or correction does not replace it
    // automatically.
    let allowed = !member.standing.second_person && !member.is_reduced;
    let rule = loaded.order.rule.no_worse_than;
    let champion = allowed && rule.is_some_and(|share| worst <= share);
    let reason =
        format!("refined with the family {} in bulk refinement {bulk}", loaded.order.family);
    let version = NewVersion {
        model: ship.clone(),
        parent: member.parent.clone(),
        law: document.model.law.clone(),
        method: METHOD.to_owned(),
        document: document.canonical()?,
        weights: None,
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
        // The alias must still be at the revision that was refined; a later change by a person
        // wins.
        let expect = self.champion.map_or(Expect::Absent, Expect::Revision);
        let named = if champion {
            step(CHAMPION, expect, reason)
        } else {
            step(CANDIDATE, Expect::Any, reason)
        };
        vec![named, self.standing.follow(reason)]
    }
}

fn unmoved(refinement: &BulkRefinement) -> bool {
    refinement.coefficients.iter().all(|c| (c.refined - c.before).abs() <= UNMOVED * c.before.abs())
}

/// Errors before and after, without the coefficients, which the version holds.
fn summary(refinement: &BulkRefinement) -> Value {
    let BulkRefinement { axes, pulled, before, after, trials, .. } = refinement;
    json!({ "axes": axes, "pulled": pulled, "before": before, "after": after, "trials": trials })
}
