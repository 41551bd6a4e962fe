//! What nobody refers to goes when it is old, and nothing else does.

use std::time::{Duration, SystemTime};

use bytes::Bytes;
use sistership_store::testing::TestDatabase;
use sistership_store::{ObjectStorage, sha256_hex};

use super::{Place, archive, found, places, trial};
use crate::archive::Archive;
use crate::upkeep::{UnreferencedObjects, collect_garbage};

#[tokio::test(flavor = "multi_thread")]
async fn garbage_goes_when_it_is_old_and_nobodys() {
    for Place { archive, .. } in &places().await {
        let orphan = archive.objects.put(Bytes::from_static(b"orphan")).await.unwrap();
        assert_eq!(found(archive).await.unreferred, UnreferencedObjects { objects: 1, bytes: 6 });
        let young = collect_garbage(archive, Duration::from_secs(3600), false).await.unwrap();
        assert_eq!(
            (young.removed.len(), young.objects),
            (0, 2),
            "what was put just now may still get its row"
        );
        tokio::time::sleep(Duration::from_millis(20)).await;
        let asked = collect_garbage(archive, Duration::ZERO, true).await.unwrap();
        assert_eq!((asked.removed.as_slice(), asked.bytes), ([orphan.clone()].as_slice(), 6));
        assert!(archive.objects.exists(&orphan).await.unwrap(), "a dry run removes nothing");
        assert_eq!(
            collect_garbage(archive, Duration::ZERO, false).await.unwrap().removed,
            std::slice::from_ref(&orphan)
        );
        assert!(!archive.objects.exists(&orphan).await.unwrap());
        assert!(found(archive).await.clean);
    }
}

/// As a process leaves them that is killed in the middle of an upload.
#[tokio::test(flavor = "multi_thread")]
async fn puts_that_never_ended_are_seen_and_go_when_they_are_old() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    let place = database.folder.path().join("objects/00/11#1");
    std::fs::create_dir_all(place.parent().unwrap()).unwrap();
    let file = std::fs::File::create(&place).unwrap();
    std::io::Write::write_all(&mut &file, b"half").unwrap();
    let findings = found(&archive).await;
    assert!(
        findings.clean && findings.unfinished == UnreferencedObjects { objects: 1, bytes: 4 },
        "{findings:#?}"
    );
    assert!(
        collect_garbage(&archive, Duration::ZERO, false).await.unwrap().unfinished.is_empty(),
        "it may be under way"
    );
    file.set_modified(SystemTime::now() - Duration::from_secs(7200)).unwrap();
    assert_eq!(
        collect_garbage(&archive, Duration::ZERO, true).await.unwrap().unfinished,
        ["objects/00/11#1"]
    );
    assert_eq!(collect_garbage(&archive, Duration::ZERO, false).await.unwrap().bytes, 4);
    assert!(!place.exists() && found(&archive).await.unfinished.objects == 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn samples_of_deleted_trials_and_of_versions_stay() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    let trial =
        archive.store.trials().find_by_hash("mariner", &sha256_hex(b"samples")).await.unwrap();
    archive.store.trials().delete(&trial.id).await.unwrap();
    tokio::time::sleep(Duration::from_millis(20)).await;
    assert!(collect_garbage(&archive, Duration::ZERO, false).await.unwrap().removed.is_empty());
    assert!(found(&archive).await.clean);
}

/// Uploads of the same bytes against a collector that takes everything that nobody refers to: no
/// trial loses its samples.
#[tokio::test(flavor = "multi_thread")]
async fn an_upload_and_the_collector_do_not_miss_each_other() {
    for Place { archive, .. } in &places().await {
        let collector = archive.clone();
        let collecting = tokio::spawn(async move {
            loop {
                collect_garbage(&collector, Duration::ZERO, false).await.unwrap();
            }
        });
        for number in 0..60 {
            upload(archive, &archive.objects, number).await;
        }
        collecting.abort();
        let findings = found(archive).await;
        assert!(findings.clean, "{findings:#?}");
        assert_eq!(findings.checked.trials, 61);
    }
}

async fn upload(archive: &Archive, objects: &ObjectStorage, number: i32) {
    for _ in 0..1000 {
        let key = objects.put(Bytes::from(format!("samples {number}"))).await.unwrap();
        tokio::task::yield_now().await;
        match archive.store.trials().insert_all_and_enqueue(&[trial(&key)], objects, |_| None).await
        {
            Err(sistership_store::StoreError::NotFound { kind: "object", .. }) => {}
            other => return drop(other.unwrap()),
        }
    }
    panic!("the collector was always first");
}
