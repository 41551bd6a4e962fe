use std::sync::Arc;

use futures::future::join_all;
use sistership_store::{ExpectedRevision, SequentialIds, Store, SystemClock};
use sqlx::{AssertSqlSafe, PgPool, SqlitePool};

use crate::support::*;

async fn every_statement_prepares(on: &TestStore) {
    assert!(on.store.prepare_every_statement().await.unwrap() > 40);
    on.store.check_health().await.unwrap();
}

async fn no_statement_reads_a_whole_table(on: &TestStore) {
    assert_eq!(on.store.full_scans().await.unwrap(), Vec::<String>::new());
}

async fn opening_twice_keeps_what_is_there(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let again = Store::connect(&on.database.url, Arc::new(SystemClock)).await.unwrap();
    assert_eq!(again.ships().get("kcs").await.unwrap(), on.store.ships().get("kcs").await.unwrap());
    again.close().await;
    assert!(again.check_health().await.is_err());
}

async fn insert_only_holds_below_the_store_too(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    crate::diagnoses::one(on).await;
    on.store.laws().insert("abkowitz", "").await.unwrap();
    on.store.effect_libraries().insert_absent("kind: effect").await.unwrap();
    on.store.versions().create(&version("kcs"), &[champion(ExpectedRevision::Any)]).await.unwrap();
    for table in [
        "laws",
        "effect_libraries",
        "ship_revisions",
        "versions",
        "alias_moves",
        "diagnoses",
        "audit",
    ] {
        for change in [
            format!("DELETE FROM {table}"),
            format!("UPDATE {table} SET id = id").replace("id = id", key(table)),
        ] {
            let error = execute(&on.database.url, change).await.unwrap_err().to_string();
            assert!(error.contains("is insert-only"), "{error}");
        }
    }
}

fn key(table: &str) -> &'static str {
    match table {
        "laws" | "effect_libraries" => "document = ''",
        "audit" => "actor = ''",
        "ship_revisions" => "document = ''",
        _ => "id = id",
    }
}

async fn execute(url: &str, sql: String) -> sqlx::Result<()> {
    match url.starts_with("sqlite") {
        true => sqlx::query(AssertSqlSafe(sql))
            .execute(&SqlitePool::connect(url).await?)
            .await
            .map(drop),
        false => {
            sqlx::query(AssertSqlSafe(sql)).execute(&PgPool::connect(url).await?).await.map(drop)
        }
    }
}

async fn open_at_once(database: TestDatabase) {
    let opening = (0..8).map(|_| {
        let url = database.url.clone();
        tokio::spawn(async move { Store::connect(&url, Arc::new(SystemClock)).await })
    });
    let stores: Vec<_> =
        join_all(opening).await.into_iter().map(|store| store.unwrap().unwrap()).collect();
    for (n, store) in stores.iter().enumerate() {
        store.ships().create(&ship(&format!("ship-{n}"))).await.unwrap();
        assert_eq!(stores[0].ships().get(&format!("ship-{n}")).await.unwrap().revision, 1);
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn many_open_a_new_sqlite_file_at_once() {
    open_at_once(TestDatabase::new_sqlite()).await;
}

/// Without the wait for the write-ahead log, all of them come to the migrations together.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn many_open_an_empty_sqlite_file_at_once() {
    for _ in 0..5 {
        let database = TestDatabase::new_sqlite();
        execute(&format!("{}?mode=rwc", database.url), "PRAGMA journal_mode = WAL".into())
            .await
            .unwrap();
        open_at_once(database).await;
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn many_open_a_new_postgres_database_at_once() {
    let Some(database) = TestDatabase::new_postgres().await else { return };
    open_at_once(database).await;
}

async fn a_store_with_migrations_of_another_version_is_refused(on: &TestStore) {
    let changes = [
        ("UPDATE _sqlx_migrations SET version = 99", "has the unknown migration 99"),
        (
            "UPDATE _sqlx_migrations SET version = 1, checksum = substr(checksum, 2)",
            "has a different migration 1",
        ),
    ];
    for (change, reason) in changes {
        on.database.execute_unchecked(change).await;
        let opened = Store::connect(&on.database.url, Arc::new(SystemClock)).await;
        assert_conflict(opened, reason);
    }
}

#[tokio::test]
async fn sqlite_in_memory_is_one_database() {
    let store = Store::connect("sqlite::memory:", Arc::new(SystemClock)).await.unwrap();
    let other = Store::connect("sqlite::memory:", Arc::new(SystemClock)).await.unwrap();
    store.ships().create(&ship("kcs")).await.unwrap();
    store.ships().get("kcs").await.unwrap();
    assert_not_found(other.ships().get("kcs").await, "ship");
}

#[tokio::test]
async fn sequential_ids_repeat() {
    let clock = || Arc::new(sistership_store::ManualClock::new(1));
    let mut ids = Vec::new();
    for _ in 0..2 {
        let store =
            Store::connect_with("sqlite::memory:", clock(), Arc::new(SequentialIds::default()))
                .await
                .unwrap();
        let (first, second) = (
            store.versions().create(&version("a"), &[]).await,
            store.versions().create(&version("a"), &[]).await,
        );
        ids.push((first.unwrap().id, second.unwrap().id));
    }
    assert_eq!(ids[0], ids[1]);
    assert!(ids[0].0 < ids[0].1);
}

#[tokio::test]
async fn another_kind_of_database_is_refused() {
    assert_invalid(
        Store::connect("mysql://localhost/x", Arc::new(SystemClock)).await,
        "database_url",
    );
}

on_both_databases!(
    every_statement_prepares,
    no_statement_reads_a_whole_table,
    opening_twice_keeps_what_is_there,
    a_store_with_migrations_of_another_version_is_refused,
    insert_only_holds_below_the_store_too
);
