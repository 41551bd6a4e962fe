//! Member of a bulk refinement: loading, refinement and outcome.

use serde_json::{Value, json};
use sistership_fleet::bulk::BulkRefinement;
use sistership_fleet::statistics::RegressionFrame;
use sistership_identification::refine::RefineError;
use sistership_store::{AliasMove, ExpectedRevision, NewOutcome, NewVersion};

use super::family_prior::recipe_trials;
use super::frame::StartingModels;
use super::order::LoadedOrder;
use super::refined::{MemberInputs, refine_member};
use super::stored_statistics::trial_statistics;
use crate::aliases::{CANDIDATE, CHAMPION, VersionHistory, server_move};
use crate::archive::Archive;
use crate::error::DeriveError;
use crate::version::VersionDocument;

type Result<T> = std::result::Result<T, DeriveError>;

/// Method name of the versions.
const METHOD: &str = "statistics";
/// Relative change below which a coefficient counts as unchanged.
const UNCHANGED_SHARE: f64 = 1e-9;

/// Ship of the chunk, ready to be refined, or the reason why it cannot be.
pub struct BulkMember {
    ship: String,
    standing: VersionHistory,
    champion: Option<i64>,
    parent: Option<String>,
    /// True if the champion has effects or a learned correction, which are not refined.
    is_reduced: bool,
    gathered: std::result::Result<MemberInputs, String>,
}

/// Refinement of a ship of the chunk, or the reason why there is none.
pub type MemberOutcome = std::result::Result<(BulkRefinement, VersionDocument), String>;

/// Loads the inputs of the refinement of a member.
///
/// # Errors
/// Returns an error of the store or of the program; an error of the ship is part of the result.
pub async fn load_member(
    archive: &Archive,
    loaded: &LoadedOrder,
    ship: &str,
) -> Result<BulkMember> {
    let standing = VersionHistory::read_current(&archive.store, ship).await?;
    let mut member = BulkMember {
        ship: ship.to_owned(),
        standing,
        champion: None,
        parent: None,
        is_reduced: false,
        gathered: Err(String::new()),
    };
    match load_inputs(archive, loaded, &mut member).await {
        Ok(gathered) => member.gathered = Ok(gathered),
        // Faults of the database, of the object store or of the program end the job; missing or
        // damaged data of a ship are its outcome.
        Err(error @ (DeriveError::Broken(_) | DeriveError::Refine(RefineError::Cancelled))) => {
            return Err(error);
        }
        Err(DeriveError::Store(error)) if !error.is_data_fault() => return Err(error.into()),
        Err(error) => member.gathered = Err(error.to_string()),
    }
    Ok(member)
}

async fn load_inputs(
    archive: &Archive,
    loaded: &LoadedOrder,
    member: &mut BulkMember,
) -> Result<MemberInputs> {
    let order = &loaded.order;
    let frames = StartingModels {
        archive,
        foundation: &order.foundation,
        model: &loaded.foundation,
        law: &loaded.law,
    };
    let framed = frames.for_member(&member.ship, order.start).await?;
    (member.champion, member.parent) = (framed.champion, framed.version_id);
    member.is_reduced = framed.is_reduced;
    let trials = recipe_trials(archive, &member.ship).await?;
    if trials.is_empty() {
        return Err(DeriveError::Lost("it has no trials".to_owned()));
    }
    let frame = RegressionFrame::new(
        &framed.model,
        &loaded.law,
        &order.law_sha256,
        order.settings.difference_s,
    )?;
    let statistics = trial_statistics(archive, &frame, &trials).await?;
    let recipe = order.member_recipe(framed.from, framed.ship_sha256, trials);
    Ok(MemberInputs { model: framed.model, statistics, recipe })
}

/// Refines a member, or returns the reason why that is not possible.
pub fn refine_or_explain(
    loaded: &LoadedOrder,
    mut member: BulkMember,
) -> (BulkMember, MemberOutcome) {
    // The inputs are large and are moved out; the rest of the member is needed for its outcome.
    let gathered = std::mem::replace(&mut member.gathered, Err(String::new()));
    let outcome = gathered.and_then(|gathered| {
        refine_member(loaded, &member.ship, gathered).map_err(|error| error.to_string())
    });
    (member, outcome)
}

/// Returns the outcome for a ship: champion if the rule allows it for its model, else candidate.
///
/// # Errors
/// Returns an error if a document cannot be written.
pub fn member_outcome(
    loaded: &LoadedOrder,
    bulk: &str,
    member: BulkMember,
    outcome: MemberOutcome,
) -> Result<NewOutcome> {
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
    let summary = change_summary(&refinement);
    // No new version if the trials do not change the model: its history would only grow.
    if is_unchanged(&refinement) {
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
        document: document.to_canonical_json()?,
        weights: None,
    };
    let outcome = if champion { CHAMPION } else { CANDIDATE }.to_owned();
    Ok(NewOutcome {
        ship,
        outcome,
        version: Some((version, member.alias_moves(champion, &reason))),
        worst_change: Some(worst),
        document: summary.to_string(),
    })
}

impl BulkMember {
    fn alias_moves(&self, champion: bool, reason: &str) -> Vec<AliasMove> {
        // The alias must still be at the revision that was refined; a later change by a person
        // wins.
        let expect = self.champion.map_or(ExpectedRevision::Absent, ExpectedRevision::Revision);
        let named = if champion {
            server_move(CHAMPION, expect, reason)
        } else {
            server_move(CANDIDATE, ExpectedRevision::Any, reason)
        };
        vec![named, self.standing.move_latest(reason)]
    }
}

fn is_unchanged(refinement: &BulkRefinement) -> bool {
    refinement
        .coefficients
        .iter()
        .all(|c| (c.refined - c.before).abs() <= UNCHANGED_SHARE * c.before.abs())
}

/// Errors before and after, without the coefficients, which the version holds.
fn change_summary(refinement: &BulkRefinement) -> Value {
    let BulkRefinement { axes, pulled, before, after, trials, .. } = refinement;
    json!({ "axes": axes, "pulled": pulled, "before": before, "after": after, "trials": trials })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_fleet::bulk::BulkSettings;
    use sistership_model::version::SourceVersion;
    use sistership_store::testing::TestDatabase;

    use super::*;
    use crate::catalogue::ZooCache;
    use crate::fleet::choices::{Rule, Start};
    use crate::fleet::order::BulkOrder;
    use crate::inputs::DerivationInputs;
    use crate::seed;
    use crate::test_rows::new_trial;

    const SHIP: &str = "mariner";

    /// An order on the published model of the ship.
    async fn loaded_order(archive: &Archive) -> LoadedOrder {
        let head = archive.store.versions().get(SHIP, 1).await.unwrap().head;
        let law_sha256 = archive.store.laws().get(&head.law).await.unwrap().sha256;
        let order = BulkOrder {
            family: "cargo".to_owned(),
            foundation: SourceVersion {
                ship: head.model,
                number: head.number,
                sha256: head.sha256,
            },
            law_sha256,
            start: Start::default(),
            prior: None,
            settings: BulkSettings::default(),
            rule: Rule::default(),
        };
        LoadedOrder::load(&DerivationInputs::new(archive), order).await.unwrap()
    }

    #[tokio::test]
    async fn an_object_store_that_does_not_answer_is_no_fault_of_the_ship() {
        let database = TestDatabase::new_sqlite();
        let archive = Archive::open(&database.url, database.folder.path()).await.unwrap();
        seed::seed_zoo(&archive.store, &ZooCache::default()).await.unwrap();
        let trial =
            archive.store.trials().insert(&new_trial(SHIP, "turn", None)).await.unwrap().row;
        let order = loaded_order(&archive).await;
        let member = load_member(&archive, &order, SHIP).await.unwrap();
        assert!(member.gathered.is_err(), "its samples are missing");
        // A file in the place of the folder of the object: it cannot be opened.
        let objects = database.folder.path().join("objects");
        std::fs::create_dir_all(&objects).unwrap();
        std::fs::write(objects.join(&trial.object_key[..2]), "").unwrap();
        match load_member(&archive, &order, SHIP).await {
            Err(DeriveError::Store(error)) => assert!(error.is_transient(), "{error}"),
            Err(error) => panic!("{error}"),
            Ok(_) => panic!("the fault of the object store is an outcome of the ship"),
        }
    }
}
