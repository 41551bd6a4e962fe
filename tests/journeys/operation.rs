//! Starting, configuring and stopping real processes.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

use sistership_store::testing::TestDatabase;
use sistership_store::{JobFilter, JobState, PageRequest, Store, SystemClock};
use sistership_tests::binary;
use sistership_tests::server::TestServer;
use sistership_tests::worker::TestWorker;

use super::over_http::{create, refine_weakly, upload_few};
use super::sea_trials::NAME;

/// A job under way, a server that is told to stop, and the job afterwards: its state and how often
/// it was begun.
async fn stopped(drain_s: &str) -> (JobState, i64) {
    let mut server = TestServer::on(TestDatabase::new_sqlite(), &["--drain-s", drain_s]).await;
    create(&server).await;
    upload_few(&server).await;
    let job = refine_weakly(&server, "drained").await;
    while server.get(&format!("/v1/jobs/{job}")).await["state"] == "queued" {
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    assert_eq!(server.terminate().code(), Some(0));
    let store =
        Store::connect(&server.database().url, Arc::new(SystemClock)).await.expect("a store");
    let job = store.jobs().get(&job).await.expect("the job");
    (job.state, job.attempt)
}

#[tokio::test]
async fn a_server_that_is_told_to_stop_ends_its_job() {
    assert_eq!(stopped("120").await, (JobState::Succeeded, 1));
}

#[tokio::test]
async fn a_server_without_time_gives_its_job_back() {
    assert_eq!(stopped("0").await, (JobState::Queued, 0), "no attempt is counted");
}

/// Processes that find an empty database at the same moment: one brings the schema in, the others
/// wait for it.
async fn begun_at_once(database: TestDatabase) {
    let data = database.folder.path().join("data").display().to_string();
    let store = ["--database-url".to_owned(), database.url.clone(), "--data-dir".to_owned(), data];
    let mut workers: Vec<TestWorker> = (0..5).map(|_| TestWorker::begin(&store, "5")).collect();
    workers.iter_mut().for_each(TestWorker::until_it_works);
    let arguments: Vec<&str> =
        ["fsck", "--json"].into_iter().chain(store.iter().map(String::as_str)).collect();
    assert!(binary::json(&arguments, 0)["checked"]["versions"].as_u64() > Some(5));
}

#[tokio::test]
async fn many_processes_begin_on_an_empty_sqlite_database() {
    begun_at_once(TestDatabase::new_sqlite()).await;
}

#[tokio::test]
async fn many_processes_begin_on_an_empty_postgres_database() {
    if let Some(database) = TestDatabase::new_postgres().await {
        begun_at_once(database).await;
    }
}

/// What `fsck` says of a store that is not there, which names the folder that it has settled on.
fn settled(config: &Path, environment: Option<&str>, flag: Option<&str>) -> String {
    let mut command = Command::new(binary::path());
    command
        .arg("fsck")
        .arg("--config")
        .arg(config)
        .args(flag.map(|flag| ["--data-dir", flag]).into_iter().flatten());
    if let Some(folder) = environment {
        command.env("SISTERSHIP_DATA_DIR", folder);
    }
    let output = command.output().expect("the program runs");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn flags_win_over_the_environment_and_that_over_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let config = folder.path().join("sistership.yaml");
    std::fs::write(&config, "data_dir: from-the-file\n").expect("a file");
    let beside = folder.path().join("from-the-file").display().to_string();
    assert!(
        settled(&config, None, None).contains(&beside),
        "a path in the file starts at its folder"
    );
    assert!(
        settled(&config, Some("/from-the-environment"), None).contains("/from-the-environment/")
    );
    assert!(
        settled(&config, Some("/from-the-environment"), Some("/from-the-flag"))
            .contains("/from-the-flag/")
    );
    std::fs::write(&config, "data_dirs: x\n").expect("a file");
    let refused = settled(&config, None, None);
    assert!(refused.contains("sistership.yaml") && refused.contains("data_dirs"), "{refused}");
}

#[tokio::test]
async fn a_server_runs_by_its_file_and_logs_in_json() {
    let database = TestDatabase::new_sqlite();
    let config = database.folder.path().join("sistership.yaml");
    std::fs::write(&config, "workers: 0\nlog: info\nlog_format: json\n").expect("a file");
    let (server, log) =
        TestServer::logged(database, &["--config", &config.display().to_string()]).await;
    create(&server).await;
    upload_few(&server).await;
    refine_weakly(&server, "waits").await;
    tokio::time::sleep(Duration::from_millis(1500)).await;
    let store =
        Store::connect(&server.database().url, Arc::new(SystemClock)).await.expect("a store");
    let jobs = store
        .jobs()
        .list(&JobFilter::default(), &PageRequest::first_page(9))
        .await
        .expect("jobs")
        .items;
    assert!(
        jobs.iter().all(|job| job.state == JobState::Queued),
        "the file says that there are no workers"
    );
    let answer = server
        .request(reqwest::Method::GET, &format!("/v1/ships/{NAME}"))
        .send()
        .await
        .expect("an answer");
    let id = answer.headers()["x-request-id"].to_str().expect("text").to_owned();
    let lines = std::fs::read_to_string(log).expect("a log");
    let lines: Vec<serde_json::Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).expect("one JSON object a line"))
        .collect();
    let line = lines
        .iter()
        .find(|line| line["span"]["id"] == id.as_str())
        .expect("a line under the id of the request");
    assert_eq!(
        (line["span"]["path"].as_str(), line["status"].as_u64()),
        (Some("/v1/ships/journey"), Some(200)),
        "{line}"
    );
}
