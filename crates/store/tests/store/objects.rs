use bytes::Bytes;
use sistership_store::{Objects, ObjectsError, StoreError, sha256_hex};

use crate::support::*;

const SAMPLES: Bytes = Bytes::from_static(b"PAR1 samples PAR1");

async fn put_and_get(objects: &Objects) -> String {
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
    put_and_get(&Objects::memory()).await;
}

#[tokio::test]
async fn a_damaged_object_is_found_out_and_healed() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("not/yet/there");
    let objects = Objects::local(&root).unwrap();
    let key = put_and_get(&objects).await;
    let file = root.join("objects").join(&key[..2]).join(&key[2..]);
    std::fs::write(&file, b"PAR1 damaged PAR1").unwrap();
    let damaged = objects.get(&key).await;
    assert!(matches!(&damaged, Err(StoreError::Objects(ObjectsError::Damaged { key: at, .. })) if *at == key), "{damaged:?}");
    objects.put(SAMPLES).await.unwrap();
    assert_eq!(Objects::local(&root).unwrap().get(&key).await.unwrap(), SAMPLES);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn many_put_the_same_bytes_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let objects = Objects::local(folder.path()).unwrap();
    let keys = futures::future::try_join_all((0..20).map(|_| objects.put(SAMPLES))).await.unwrap();
    assert!(keys.iter().all(|key| *key == keys[0]));
    assert_eq!(objects.get(&keys[0]).await.unwrap(), SAMPLES);
}

#[tokio::test]
async fn a_key_is_a_hash_and_no_path() {
    for key in ["", "../../etc/passwd", &"g".repeat(64), &"A".repeat(64)] {
        assert_invalid(Objects::memory().get(key).await, "key");
        assert_invalid(Objects::memory().exists(key).await, "key");
    }
}
