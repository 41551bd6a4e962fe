use std::path::PathBuf;
use std::sync::Arc;

use sistership_store::testing::TestS3;
use sistership_store::{
    BackupManifest, ExpectedRevision, ObjectStorage, PageRequest, Store, SystemClock,
};

use crate::support::*;

/// A store with a row in most tables, and the object of its trial.
async fn filled(on: &TestStore) -> ObjectStorage {
    let objects = ObjectStorage::open_folder(&on.database.folder.path().join("data")).unwrap();
    objects.put("turn".into()).await.unwrap();
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let strange = ship("kcs\u{1F6A2}");
    let document = "{\"text\":\"tab\\t line\\n \\\\. \\\\N quote' ü\"}".to_owned();
    on.store
        .ships()
        .create(&sistership_store::NewShip { title: "a\tb\\N\n\\.\nc".into(), document, ..strange })
        .await
        .unwrap();
    on.store.trials().insert(&trial("kcs", "turn")).await.unwrap();
    on.store.versions().create(&version("kcs"), &[champion(ExpectedRevision::Any)]).await.unwrap();
    crate::diagnoses::one(on).await;
    objects
}

fn folder(on: &TestStore, name: &str) -> PathBuf {
    on.database.folder.path().join(name)
}

/// An empty database of the same kind.
async fn empty(on: &TestStore) -> TestDatabase {
    match on.database.url.starts_with("sqlite") {
        true => TestDatabase::new_sqlite(),
        false => TestDatabase::new_postgres().await.unwrap(),
    }
}

async fn what_is_restored_is_what_was_backed_up(on: &TestStore) {
    let objects = filled(on).await;
    let manifest = on.store.backup(&objects, &folder(on, "backup")).await.unwrap();
    assert_eq!((manifest.objects, manifest.object_bytes, manifest.lost.len()), (1, 4, 0));
    let there = empty(on).await;
    let copies = ObjectStorage::in_memory();
    Store::restore(&folder(on, "backup"), &there.url, &copies).await.unwrap();
    let store = Store::connect(&there.url, Arc::new(SystemClock)).await.unwrap();
    let page = PageRequest::first_page(100);
    assert_eq!(
        store.ships().list(None, &page).await.unwrap(),
        on.store.ships().list(None, &page).await.unwrap()
    );
    assert_eq!(
        store.trials().list_all(&page).await.unwrap(),
        on.store.trials().list_all(&page).await.unwrap()
    );
    assert_eq!(
        store.versions().list_all(&page).await.unwrap(),
        on.store.versions().list_all(&page).await.unwrap()
    );
    assert_eq!(
        store.diagnoses().list_all(&page).await.unwrap(),
        on.store.diagnoses().list_all(&page).await.unwrap()
    );
    let every = Default::default();
    assert_eq!(
        store.jobs().list(&every, &page).await.unwrap(),
        on.store.jobs().list(&every, &page).await.unwrap()
    );
    assert!(store.row_faults().await.unwrap().is_empty());
    assert!(copies.exists(&trial("kcs", "turn").object_key).await.unwrap());
    let latest = on.store.versions().latest("kcs").await.unwrap().head.number;
    let next =
        store.versions().create(&version("kcs"), &[champion(ExpectedRevision::Any)]).await.unwrap();
    assert_eq!(next.number, latest + 1, "what is made next is numbered on");
}

async fn a_bucket_is_backed_up_and_restored_into_another(on: &TestStore) {
    let s3 = TestS3::start().await;
    let (objects, copies) = (s3.open_objects("one"), s3.open_objects("another"));
    drop(filled(on).await);
    for samples in ["turn", "nobody's"] {
        objects.put(samples.into()).await.unwrap();
    }
    let backup = folder(on, "backup");
    let manifest = on.store.backup(&objects, &backup).await.unwrap();
    assert_eq!((manifest.objects, manifest.object_bytes, manifest.lost.len()), (1, 4, 0));
    assert_conflict(Store::restore(&backup, &empty(on).await.url, &objects).await, "is not empty");
    Store::restore(&backup, &empty(on).await.url, &copies).await.unwrap();
    assert_eq!(copies.get(&trial("kcs", "turn").object_key).await.unwrap(), "turn");
}

async fn a_place_that_is_not_empty_is_refused(on: &TestStore) {
    let objects = filled(on).await;
    let backup = folder(on, "backup");
    on.store.backup(&objects, &backup).await.unwrap();
    assert_conflict(on.store.backup(&objects, &backup).await, "not empty");
    assert_conflict(
        Store::restore(&backup, &on.database.url, &ObjectStorage::in_memory()).await,
        "empty",
    );
    let there = empty(on).await;
    assert_conflict(Store::restore(&backup, &there.url, &objects).await, "empty");
    Store::restore(&backup, &there.url, &ObjectStorage::in_memory())
        .await
        .expect("the refusals left nothing behind");
}

async fn a_backup_that_is_damaged_is_refused(on: &TestStore) {
    let objects = filled(on).await;
    let backup = folder(on, "backup");
    let manifest = on.store.backup(&objects, &backup).await.unwrap();
    let there = empty(on).await;
    let file = backup.join(manifest.files.keys().next().unwrap());
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(&file, [bytes.as_slice(), b" "].concat()).unwrap();
    assert_conflict(
        Store::restore(&backup, &there.url, &ObjectStorage::in_memory()).await,
        "damaged",
    );
    std::fs::write(&file, bytes).unwrap();
    let key = trial("kcs", "turn").object_key;
    std::fs::remove_file(backup.join("objects").join(&key[..2]).join(&key[2..])).unwrap();
    assert_conflict(
        Store::restore(&backup, &there.url, &ObjectStorage::in_memory()).await,
        "has 0 objects, but had 1",
    );
    std::fs::remove_file(backup.join("backup.json")).unwrap();
    assert_conflict(
        Store::restore(&backup, &there.url, &ObjectStorage::in_memory()).await,
        "backup.json is missing",
    );
}

async fn a_backup_of_another_kind_or_a_newer_program_is_refused(on: &TestStore) {
    let objects = filled(on).await;
    let backup = folder(on, "backup");
    let manifest = on.store.backup(&objects, &backup).await.unwrap();
    let other = if on.database.url.starts_with("sqlite") {
        "postgres://localhost/x"
    } else {
        "sqlite://x.db"
    };
    assert_invalid(
        Store::restore(&backup, other, &ObjectStorage::in_memory()).await,
        "database_url",
    );
    let newer = BackupManifest { schema: manifest.schema + 1, ..manifest };
    std::fs::write(backup.join("backup.json"), serde_json::to_vec(&newer).unwrap()).unwrap();
    assert_conflict(
        Store::restore(&backup, &empty(on).await.url, &ObjectStorage::in_memory()).await,
        "newer version",
    );
}

async fn samples_that_are_lost_are_told_and_the_rest_is_kept(on: &TestStore) {
    filled(on).await;
    let manifest =
        on.store.backup(&ObjectStorage::in_memory(), &folder(on, "backup")).await.unwrap();
    assert_eq!(manifest.lost, [trial("kcs", "turn").object_key]);
    let there = empty(on).await;
    Store::restore(&folder(on, "backup"), &there.url, &ObjectStorage::in_memory()).await.unwrap();
}

#[tokio::test(flavor = "multi_thread")]
async fn every_table_is_backed_up() {
    let Some(database) = TestDatabase::new_postgres().await else { return };
    let on = database.open().await;
    let manifest =
        on.store.backup(&ObjectStorage::in_memory(), &folder(&on, "backup")).await.unwrap();
    let pool = sqlx::PgPool::connect(&on.database.url).await.unwrap();
    let sql = "SELECT CAST(table_name AS TEXT) FROM information_schema.tables \
        WHERE table_schema = current_schema() AND table_name <> '_sqlx_migrations' ORDER BY 1";
    let there: Vec<String> = sqlx::query_scalar(sql).fetch_all(&pool).await.unwrap();
    let mut copied: Vec<String> = manifest.tables.into_iter().map(|table| table.name).collect();
    copied.sort();
    assert_eq!(copied, there);
}

#[tokio::test]
async fn a_database_in_memory_is_refused() {
    let store = Store::connect("sqlite::memory:", Arc::new(SystemClock)).await.unwrap();
    let folder = tempfile::tempdir().unwrap();
    assert_invalid(
        store.backup(&ObjectStorage::in_memory(), &folder.path().join("backup")).await,
        "database_url",
    );
}

on_both_databases!(
    what_is_restored_is_what_was_backed_up,
    a_bucket_is_backed_up_and_restored_into_another,
    a_place_that_is_not_empty_is_refused,
    a_backup_that_is_damaged_is_refused,
    a_backup_of_another_kind_or_a_newer_program_is_refused,
    samples_that_are_lost_are_told_and_the_rest_is_kept
);
