use std::path::Path;
use std::time::{Duration, Instant};

use bytes::Bytes;
use futures::TryStreamExt as _;
use sistership_store::testing::{FaultyBucket, TestS3};
use sistership_store::{ObjectName, ObjectStorage, ObjectsError, StoreError, sha256_hex};

use crate::support::*;

const SAMPLES: Bytes = Bytes::from_static(b"PAR1 samples PAR1");

async fn put_and_get(objects: &ObjectStorage) -> String {
    let key = objects.put(SAMPLES).await.unwrap();
    assert_eq!(key, sha256_hex(&SAMPLES));
    assert_eq!(objects.put(SAMPLES).await.unwrap(), key);
    assert_eq!(objects.get(&key).await.unwrap(), SAMPLES);
    assert!(objects.exists(&key).await.unwrap());
    let other = sha256_hex(b"");
    assert!(!objects.exists(&other).await.unwrap());
    assert_not_found(objects.get(&other).await, "object");
    key
}

#[tokio::test]
async fn objects_in_memory() {
    put_and_get(&ObjectStorage::in_memory()).await;
}

/// An object whose bytes another program has changed.
async fn damaged_and_healed(objects: &ObjectStorage, root: &Path) {
    let key = put_and_get(objects).await;
    let file = root.join("objects").join(&key[..2]).join(&key[2..]);
    std::fs::write(&file, b"PAR1 damaged PAR1").unwrap();
    let damaged = objects.get(&key).await;
    assert!(
        matches!(&damaged, Err(StoreError::Objects(ObjectsError::Damaged { key: at, .. })) if *at == key),
        "{damaged:?}"
    );
    objects.put(SAMPLES).await.unwrap();
    assert_eq!(objects.get(&key).await.unwrap(), SAMPLES);
}

#[tokio::test]
async fn a_damaged_object_is_found_out_and_healed() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("not/yet/there");
    damaged_and_healed(&ObjectStorage::open_folder(&root).unwrap(), &root).await;
    assert_eq!(
        ObjectStorage::open_folder(&root).unwrap().get(&sha256_hex(&SAMPLES)).await.unwrap(),
        SAMPLES
    );
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn objects_in_a_bucket() {
    let s3 = TestS3::start().await;
    let objects = s3.open_objects("fleet/a");
    assert_not_found(objects.check_health().await, "object");
    objects.write_marker().await.unwrap();
    objects.check_health().await.unwrap();
    damaged_and_healed(&objects, &s3.folder.path().join("samples/fleet/a")).await;
    many(&objects).await;
    let others = objects.put(Bytes::from_static(b"others")).await.unwrap();
    let mut listed: Vec<_> =
        objects.list().map_ok(|head| (head.name, head.bytes)).try_collect().await.unwrap();
    listed.sort_by_key(|(_, bytes)| *bytes);
    let expected = [(others, 6), (sha256_hex(&SAMPLES), SAMPLES.len() as u64)]
        .map(|(key, bytes)| (ObjectName::Key(key), bytes));
    assert_eq!(listed, expected);
    // Another prefix of the bucket is another store.
    assert_not_found(s3.open_objects("fleet/b").get(&sha256_hex(&SAMPLES)).await, "object");
    assert_eq!(objects.list_staged().await.unwrap(), []);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_bucket_that_does_not_let_one_in_is_an_error_and_no_missing_object() {
    let s3 = TestS3::start().await;
    let stranger = s3.objects_as("somebody", "fleet/a");
    assert!(matches!(
        stranger.put(SAMPLES).await,
        Err(StoreError::Objects(ObjectsError::Store(_)))
    ));
    assert!(matches!(
        stranger.exists(&sha256_hex(&SAMPLES)).await,
        Err(StoreError::Objects(ObjectsError::Store(_)))
    ));
    assert!(stranger.check_health().await.is_err());
}

/// Faults of a bucket are errors that may pass, which a client is asked to retry (503), and none
/// of them takes longer than half a minute to be noticed.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn faults_of_a_bucket_are_noticed_and_may_pass() {
    let key = sha256_hex(&SAMPLES);
    let faulty = async |status: Option<u16>| {
        let bucket = FaultyBucket::start(status).await;
        let objects = bucket.open_objects();
        let start = Instant::now();
        assert!(objects.check_health().await.is_err());
        assert!(start.elapsed() < Duration::from_secs(1), "{status:?}: {:?}", start.elapsed());
        let marked = objects.write_marker().await.unwrap_err();
        assert!(marked.is_transient(), "{status:?}: {marked}");
        assert!(start.elapsed() < Duration::from_secs(5), "{status:?}: {:?}", start.elapsed());
        if status.is_none() {
            // The deadline of the other operations, which is the same code, is twenty seconds.
            return;
        }
        for answer in [
            objects.put(SAMPLES).await.map(drop),
            objects.get(&key).await.map(drop),
            objects.exists(&key).await.map(drop),
            objects.get_stream(&key).await.map(drop),
        ] {
            let error = answer.unwrap_err();
            assert!(error.is_transient() && !error.is_data_fault(), "{status:?}: {error}");
        }
        assert!(start.elapsed() < Duration::from_secs(30), "{status:?}: {:?}", start.elapsed());
    };
    tokio::join!(faulty(Some(500)), faulty(Some(503)), faulty(Some(403)), faulty(None));
}

/// As a process leaves them that is killed in the middle of a put.
#[tokio::test]
async fn puts_that_never_ended_are_seen() {
    let folder = tempfile::tempdir().unwrap();
    let objects = ObjectStorage::open_folder(folder.path()).unwrap();
    assert_eq!(objects.list_staged().await.unwrap(), []);
    let key = objects.put(SAMPLES).await.unwrap();
    let place = format!("objects/{}/{}#1", &key[..2], &key[2..]);
    std::fs::write(folder.path().join(&place), b"PAR1").unwrap();
    let staged = objects.list_staged().await.unwrap();
    assert_eq!(
        staged.iter().map(|staged| (staged.path.as_str(), staged.bytes)).collect::<Vec<_>>(),
        [(place.as_str(), 4)]
    );
    objects.remove_staged(&staged[0]).await.unwrap();
    objects.remove_staged(&staged[0]).await.unwrap();
    assert_eq!(objects.list_staged().await.unwrap(), []);
    assert_eq!(objects.get(&key).await.unwrap(), SAMPLES);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn many_put_the_same_bytes_at_once() {
    let folder = tempfile::tempdir().unwrap();
    many(&ObjectStorage::open_folder(folder.path()).unwrap()).await;
}

async fn many(objects: &ObjectStorage) {
    let keys = futures::future::try_join_all((0..20).map(|_| objects.put(SAMPLES))).await.unwrap();
    assert!(keys.iter().all(|key| *key == keys[0]));
    assert_eq!(objects.get(&keys[0]).await.unwrap(), SAMPLES);
}

#[tokio::test]
async fn a_key_is_a_hash_and_no_path() {
    for key in ["", "../../etc/passwd", &"g".repeat(64), &"A".repeat(64)] {
        assert_invalid(ObjectStorage::in_memory().get(key).await, "key");
        assert_invalid(ObjectStorage::in_memory().exists(key).await, "key");
    }
}
