#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use bytes::Bytes;
use sistership_store::testing::{TestDatabase, TestS3};
use sistership_store::{GrantRow, NewTrial, Store, SystemClock};

use super::{Findings, check_archive};
use crate::archive::Archive;
use crate::catalogue::ZooCache;
use crate::seed;

mod damage;
mod garbage;

/// An archive with the zoo, one trial of the Mariner, and all that a job may leave.
async fn archive(database: &TestDatabase) -> Archive {
    filled(Archive::open(&database.url, database.folder.path()).await.unwrap()).await
}

async fn filled(archive: Archive) -> Archive {
    seed::seed_zoo(&archive.store, &ZooCache::default()).await.unwrap();
    let key = archive.objects.put(Bytes::from_static(b"samples")).await.unwrap();
    archive.store.trials().insert(&trial(&key)).await.unwrap();
    let role =
        GrantRow { scope_kind: "ship".into(), scope_name: "mariner".into(), role: "reader".into() };
    archive.store.users().create("ann", "Ann", Some("hash"), &[role]).await.unwrap();
    archive
}

fn trial(key: &str) -> NewTrial {
    let text = |text: &str| text.to_owned();
    NewTrial {
        ship: text("mariner"),
        sha256: text(key),
        name: text("turn.csv"),
        manifest: text("{}"),
        conventions: text("{}"),
        manoeuvre: None,
        sample_rows: 1,
        duration_s: 1.0,
        warnings: text("[]"),
        object_key: text(key),
    }
}

async fn found(archive: &Archive) -> Findings {
    check_archive(archive).await.unwrap()
}

async fn databases() -> Vec<TestDatabase> {
    [Some(TestDatabase::new_sqlite()), TestDatabase::new_postgres().await]
        .into_iter()
        .flatten()
        .collect()
}

/// An archive, and what must live as long as it does.
struct Place {
    archive: Archive,
    _database: TestDatabase,
    _s3: Option<TestS3>,
}

/// Each database with samples in a folder, and with samples in a bucket.
async fn places() -> Vec<Place> {
    let mut places = Vec::new();
    for database in databases().await {
        places.push(Place { archive: archive(&database).await, _database: database, _s3: None });
    }
    for database in databases().await {
        let s3 = TestS3::start().await;
        let (store, objects) = (
            Store::connect(&database.url, Arc::new(SystemClock)).await.unwrap(),
            s3.open_objects("fleet"),
        );
        places.push(Place {
            archive: filled(Archive { store, objects }).await,
            _database: database,
            _s3: Some(s3),
        });
    }
    places
}
