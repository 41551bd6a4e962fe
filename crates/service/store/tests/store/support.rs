//! What the tests share.

use std::fmt::Debug;

use sistership_store::{
    AliasMove, AuditFilter, ExpectedRevision, NewJob, NewReport, NewShip, NewTrial, NewVersion,
    PageRequest, Result, StoreError, VersionHead, sha256_hex,
};

pub use sistership_store::testing::{TestDatabase, TestStore};

/// Makes two tests of each function: one on SQLite, one on PostgreSQL.
macro_rules! on_both_databases {
    ($($name:ident),* $(,)?) => {
        mod sqlite {$(
            #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
            async fn $name() {
                super::$name(&$crate::support::TestDatabase::new_sqlite().open().await).await;
            }
        )*}

        mod postgres {$(
            #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
            async fn $name() {
                let Some(database) = $crate::support::TestDatabase::new_postgres().await else { return };
                super::$name(&database.open().await).await;
            }
        )*}
    };
}

pub fn ship(name: &str) -> NewShip {
    let document = format!(r#"{{"name":"{name}","lpp_m":320.0}}"#);
    NewShip { name: name.into(), title: name.to_uppercase(), category: "tanker".into(), document }
}

pub fn trial(ship: &str, samples: &str) -> NewTrial {
    let hash = sha256_hex(samples.as_bytes());
    NewTrial {
        ship: ship.into(),
        sha256: hash.clone(),
        name: format!("{samples}.csv"),
        manifest: "{}".into(),
        conventions: r#"{"rudder_positive":"starboard_turn"}"#.into(),
        manoeuvre: Some("zigzag 10/10".into()),
        sample_rows: 1200,
        duration_s: 599.5,
        warnings: "[]".into(),
        object_key: hash,
    }
}

pub fn version(model: &str) -> NewVersion {
    let (law, method) = ("abkowitz".into(), "published".into());
    NewVersion {
        model: model.into(),
        parent: None,
        law,
        method,
        document: r#"{"coefficients":{}}"#.into(),
        weights: None,
    }
}

pub fn report(ship: &str) -> NewReport {
    let (document, html) = (r#"{"rmse":0.1}"#.into(), "<p>0.1</p>".into());
    NewReport { version_id: None, ship: ship.into(), kind: "refinement".into(), document, html }
}

pub fn job(ship: &str) -> NewJob {
    NewJob {
        kind: "refinement".into(),
        ship: Some(ship.into()),
        request: r#"{"source":"auto"}"#.into(),
        small: false,
    }
}

pub fn champion(expect: ExpectedRevision) -> AliasMove {
    AliasMove { alias: "champion".into(), expect, reason: "better".into(), actor: "ann".into() }
}

/// Makes `count` versions of a model.
pub async fn versions(on: &TestStore, model: &str, count: usize) -> Vec<VersionHead> {
    let mut made = Vec::new();
    for _ in 0..count {
        made.push(on.store.versions().create(&version(model), &[]).await.unwrap());
    }
    made
}

/// Returns the actions of the audit, the latest first.
pub async fn audited_actions(on: &TestStore) -> Vec<String> {
    let page = PageRequest::first_page(100);
    let entries = on.store.audit().list(AuditFilter::All, &page).await.unwrap().items;
    entries.into_iter().map(|entry| entry.action).collect()
}

#[track_caller]
pub fn assert_not_found<T: Debug>(result: Result<T>, expected: &str) {
    match result {
        Err(StoreError::NotFound { kind, .. }) => assert_eq!(kind, expected),
        other => panic!("expected no {expected}, got {other:?}"),
    }
}

#[track_caller]
pub fn assert_conflict<T: Debug>(result: Result<T>, expected: &str) {
    match result {
        Err(StoreError::Conflict { message, .. }) => {
            assert!(message.contains(expected), "{message}")
        }
        other => panic!("expected a conflict ({expected}), got {other:?}"),
    }
}

#[track_caller]
pub fn assert_stale<T: Debug>(result: Result<T>, expected: Option<i64>) {
    match result {
        Err(StoreError::PreconditionFailed { current, .. }) => assert_eq!(current, expected),
        other => panic!("expected a failed precondition at {expected:?}, got {other:?}"),
    }
}

#[track_caller]
pub fn assert_invalid<T: Debug>(result: Result<T>, expected: &str) {
    match result {
        Err(StoreError::Invalid { field, .. }) => assert_eq!(field, expected),
        other => panic!("expected {expected} to be refused, got {other:?}"),
    }
}
