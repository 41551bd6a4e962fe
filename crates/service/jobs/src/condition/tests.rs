//! Conditions of a champion with more diagnoses than a page has.
#![allow(clippy::unwrap_used)]

use sistership_store::testing::{TestDatabase, TestStore};
use sistership_store::{ExpectedRevision, NewReport, NewShip, NewVersion};

use super::{Condition, ModelValidity};
use crate::aliases::{CHAMPION, server_move};
use crate::test_rows::new_trial;

const SHIP: &str = "kcs";

/// Ids of a version and its report.
struct ChampionRows {
    version: String,
    report: String,
}

/// A ship with a champion and a report on it.
async fn champion(on: &TestStore) -> ChampionRows {
    let text = |text: &str| text.to_owned();
    let (name, title, category) = (text(SHIP), text("KCS"), text("container"));
    on.store
        .ships()
        .create(&NewShip { name, title, category, document: text("{}") })
        .await
        .unwrap();
    let (law, method) = (text("abkowitz"), text("weak"));
    let new = NewVersion {
        model: text(SHIP),
        parent: None,
        law,
        method,
        document: text("{}"),
        weights: None,
    };
    let moves = [server_move(CHAMPION, ExpectedRevision::Absent, "test")];
    let version = on.store.versions().create(&new, &moves).await.unwrap().id;
    let (kind, document, html) = (text("diagnosis"), text("{}"), text("<p></p>"));
    let report =
        NewReport { version_id: Some(version.clone()), ship: text(SHIP), kind, document, html };
    let report = on.store.reports().insert(&report).await.unwrap().id;
    ChampionRows { version, report }
}

async fn trial(on: &TestStore, name: &str) -> String {
    on.store.trials().insert(&new_trial(SHIP, name, None)).await.unwrap().row.id
}

#[tokio::test]
async fn the_oldest_of_many_diagnoses_counts() {
    let on = TestDatabase::new_sqlite().open().await;
    let ChampionRows { version, report } = champion(&on).await;
    let (first, second) = (trial(&on, "first").await, trial(&on, "second").await);
    // One diagnosis contradicts the champion on the first trial, 1500 later ones hold on the second.
    let insert = format!(
        "INSERT INTO diagnoses (id, version_id, report_id, verdict, effects, trials, unexplained, \
         created_us) WITH RECURSIVE numbers(n) AS (SELECT 0 UNION ALL SELECT n + 1 FROM numbers \
         WHERE n < 1500) SELECT printf('%04d', n), '{version}', '{report}', CASE n WHEN 0 THEN \
         'unexplained' ELSE 'complete' END, '[]', CASE n WHEN 0 THEN '[\"{first}\"]' ELSE \
         '[\"{second}\"]' END, CASE n WHEN 0 THEN '[\"{first}\"]' ELSE '[]' END, n FROM numbers"
    );
    on.database.execute_unchecked(&insert).await;
    let condition = Condition::read_current(&on.store, SHIP).await.unwrap();
    assert_eq!(condition.trials, [first.clone(), second]);
    assert_eq!((condition.model, condition.against), (ModelValidity::DoesNotHold, vec![first]));
}
