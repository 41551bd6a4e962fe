//! A backup taken while a writer keeps writing, restored in an empty place: it holds what was
//! acknowledged before it began, nothing that was begun after it ended, and no gap in between.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use reqwest::Method;
use serde_json::{Value, json};
use sistership_store::testing::{TestDatabase, TestS3};
use sistership_tests::binary;
use sistership_tests::server::{Bucket, TestServer, json as answer};

use super::over_http::{create, refine_weakly, upload_few};
use super::sea_trials::NAME;

/// What a writer has begun, and what was acknowledged to it.
#[derive(Default)]
struct Ledger {
    begun: AtomicUsize,
    acknowledged: AtomicUsize,
}

/// Writes one trial after another, each with samples of its own.
async fn write(server: &TestServer, ledger: &Ledger, stop: &AtomicUsize) {
    while stop.load(Ordering::SeqCst) == 0 {
        let number = ledger.begun.fetch_add(1, Ordering::SeqCst);
        let rows: String = (0..4).map(|row| format!("{row},{row}.{number:06}\n")).collect();
        let path = format!("/v1/trials?ship={NAME}&name={}&diagnose=false", trial(number));
        let request = server
            .request(Method::POST, &path)
            .header("content-type", "text/csv")
            .body(format!("t_s,u_m_s\n{rows}"));
        let (status, written) = answer(request.send().await.expect("an answer")).await;
        assert_eq!((status, written["new"].as_u64()), (201, Some(1)), "{written}");
        ledger.acknowledged.fetch_add(1, Ordering::SeqCst);
    }
}

fn trial(number: usize) -> String {
    format!("written-{number}.csv")
}

async fn until(ledger: &Ledger, acknowledged: usize) {
    while ledger.acknowledged.load(Ordering::SeqCst) < acknowledged {
        tokio::time::sleep(std::time::Duration::from_millis(5)).await;
    }
}

/// Runs a command beside the writer.
async fn run(arguments: Vec<String>, bucket: Option<&Bucket>) -> Value {
    let environment = bucket.map_or_else(Vec::new, |bucket| bucket.environment.clone());
    let run = move || {
        binary::json_with(
            &arguments.iter().map(String::as_str).collect::<Vec<_>>(),
            &environment,
            0,
        )
    };
    tokio::task::spawn_blocking(run).await.expect("a command")
}

fn command(name: &str, folder: &Path, store: &[String; 4], bucket: Option<&Bucket>) -> Vec<String> {
    let words = [name.to_owned(), folder.display().to_string(), "--json".to_owned()]
        .into_iter()
        .chain(store.clone());
    words.chain(bucket.into_iter().flat_map(|bucket| bucket.arguments.clone())).collect()
}

/// Where the samples of the store are, and where those of the restored one shall be, if in buckets.
type Buckets = Option<[Bucket; 2]>;

async fn backed_up(server: TestServer, empty: TestDatabase, buckets: Buckets) {
    let (from, to) = (buckets.as_ref().map(|[from, _]| from), buckets.as_ref().map(|[_, to]| to));
    create(&server).await;
    upload_few(&server).await;
    let done = server.finished(&refine_weakly(&server, "before").await).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    let folder = server.database().folder.path().join("backup");
    let (ledger, stop) = (Arc::new(Ledger::default()), AtomicUsize::new(0));
    let during = async {
        until(&ledger, 10).await;
        let before = ledger.acknowledged.load(Ordering::SeqCst);
        let manifest = run(command("backup", &folder, &server.store_arguments(), from), from).await;
        let after = ledger.begun.load(Ordering::SeqCst);
        until(&ledger, after + 5).await;
        stop.store(1, Ordering::SeqCst);
        assert_eq!(manifest["lost"], json!([]), "{manifest}");
        (before, after)
    };
    let ((), (before, after)) = tokio::join!(write(&server, &ledger, &stop), during);
    let original = contents(&server).await;
    let restored = restored(&folder, empty, to).await;
    let kept = restored.get(&format!("/v1/trials?ship={NAME}&limit=1000")).await;
    let names: Vec<&str> = kept["items"]
        .as_array()
        .expect("trials")
        .iter()
        .filter_map(|trial| trial["name"].as_str())
        .collect();
    let written: Vec<&str> =
        names.iter().copied().filter(|name| name.starts_with("written-")).collect();
    let expected: Vec<String> = (0..written.len()).map(trial).collect();
    assert_eq!(written, expected, "a beginning of the ledger, without gaps");
    assert!(
        (before..=after).contains(&written.len()),
        "{} of the ledger, not {before} to {after}",
        written.len()
    );
    same(&original, &contents(&restored).await, names.len());
}

/// Ships, trials, versions and where the aliases stand.
async fn contents(server: &TestServer) -> Vec<Value> {
    let paths = [
        format!("/v1/trials?ship={NAME}&limit=1000"),
        "/v1/ships?limit=1000".to_owned(),
        format!("/v1/models/{NAME}/versions/1"),
        format!("/v1/models/{NAME}/aliases/champion/history"),
        "/v1/laws?limit=1000".to_owned(),
    ];
    let mut contents = Vec::new();
    for path in &paths {
        contents.push(server.get(path).await);
    }
    contents
}

/// The restored store is the original one, but for the trials that came after the backup.
fn same(original: &[Value], restored: &[Value], trials: usize) {
    assert_eq!(
        original[0]["items"].as_array().expect("trials")[..trials],
        restored[0]["items"].as_array().expect("trials")[..]
    );
    assert_eq!(original[1..], restored[1..]);
}

/// A server on what a backup gives; its store is clean, and a second restoration into it is
/// refused.
async fn restored(folder: &Path, empty: TestDatabase, bucket: Option<&Bucket>) -> TestServer {
    let data = empty.folder.path().join("data");
    let store = [
        "--database-url".into(),
        empty.url.clone(),
        "--data-dir".into(),
        data.display().to_string(),
    ];
    run(command("restore", folder, &store, bucket), bucket).await;
    let fsck = command("fsck", folder, &store, bucket)
        .into_iter()
        .filter(|word| *word != folder.display().to_string());
    let findings = run(fsck.collect(), bucket).await;
    assert_eq!(
        (&findings["clean"], &findings["unreferred"]["objects"]),
        (&json!(true), &json!(0)),
        "{findings}"
    );
    let again = command("restore", folder, &store, bucket);
    let environment = bucket.map_or_else(Vec::new, |bucket| bucket.environment.clone());
    let refused =
        binary::run_with(&again.iter().map(String::as_str).collect::<Vec<_>>(), &environment);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("empty"), "{refused:?}");
    match bucket {
        Some(bucket) => TestServer::with_bucket(empty, bucket).await,
        None => TestServer::on(empty, &[]).await,
    }
}

#[tokio::test]
async fn backed_up_on_sqlite() {
    backed_up(TestServer::sqlite().await, TestDatabase::new_sqlite(), None).await;
}

#[tokio::test]
async fn backed_up_on_postgres() {
    if let (Some(server), Some(empty)) =
        (TestServer::postgres().await, TestDatabase::new_postgres().await)
    {
        backed_up(server, empty, None).await;
    }
}

/// Samples in one bucket, restored into another; on two threads, because the S3 server is in this
/// process.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn backed_up_from_a_bucket_into_another() {
    let s3 = TestS3::start().await;
    let buckets = ["one", "another"].map(|prefix| Bucket::of(&s3, prefix));
    let server = TestServer::with_bucket(TestDatabase::new_sqlite(), &buckets[0]).await;
    backed_up(server, TestDatabase::new_sqlite(), Some(buckets)).await;
}
