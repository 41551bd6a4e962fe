//! The server is killed in the middle of a refinement: what was acknowledged is there, and the job
//! goes on or says why not.

use std::time::Duration;

use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;
use sistership_tests::worker::TestWorker;

use super::over_http::{create, refine_weakly, upload_few, verified};
use super::sea_trials::NAME;

async fn killed(mut server: TestServer) {
    create(&server).await;
    let uploaded = upload_few(&server).await;
    let first = server.finished(&refine_weakly(&server, "before").await).await;
    assert_eq!(first["state"], "succeeded", "{first}");
    let job = refine_weakly(&server, "during").await;
    while server.get(&format!("/v1/jobs/{job}")).await["state"] == "queued" {
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    server.kill();
    server.restart().await;
    let trials = server.get(&format!("/v1/trials?ship={NAME}")).await;
    let ids = |list: &serde_json::Value| {
        list.as_array().expect("a list").iter().map(|trial| trial["id"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(
        ids(&trials["items"]),
        ids(&uploaded["trials"]),
        "every acknowledged trial is there"
    );
    assert_eq!(server.get(&format!("/v1/models/{NAME}/versions/1")).await["version"]["number"], 1);
    let done = server.finished(&job).await;
    assert_eq!(done["state"], "succeeded", "the job was taken up again: {done}");
    assert!(done["attempt"].as_i64() >= Some(1), "{done}");
    assert_eq!(done["result"]["version"], 2, "one version for one request: {done}");
    verified(&server, 1).await;
    verified(&server, 2).await;
}

#[tokio::test]
async fn killed_on_sqlite() {
    killed(TestServer::sqlite().await).await;
}

#[tokio::test]
async fn killed_on_postgres() {
    if let Some(server) = TestServer::postgres().await {
        killed(server).await;
    }
}

/// Waits until a job has been begun this often and runs.
async fn running(server: &TestServer, job: &str, attempt: i64) {
    for _ in 0..30_000 {
        let state = server.get(&format!("/v1/jobs/{job}")).await;
        if state["state"] == "running" && state["attempt"] == attempt {
            return;
        }
        assert!(state["state"] == "queued" || state["attempt"] != attempt, "{state}");
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    panic!("job {job} is not begun {attempt} times");
}

/// A job during which its worker's process ends twice is set aside, other jobs go on, and a person
/// may have it done again.
async fn set_aside(database: TestDatabase) {
    let server = TestServer::on(database, &["--no-worker"]).await;
    create(&server).await;
    upload_few(&server).await;
    let poison = refine_weakly(&server, "poison").await;
    for attempt in 1..=2 {
        let mut worker = TestWorker::start(&server, "1");
        running(&server, &poison, attempt).await;
        worker.kill();
    }
    let healthy = refine_weakly(&server, "healthy").await;
    let _worker = TestWorker::start(&server, "1");
    let failed = server.finished(&poison).await;
    assert_eq!((&failed["state"], &failed["attempt"]), (&"failed".into(), &2.into()), "{failed}");
    let error = failed["error"].as_str().unwrap_or_default();
    assert!(
        error.contains("the process of the job ended twice")
            && error.contains("not restarted automatically"),
        "{error}"
    );
    let done = server.finished(&healthy).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    let again = server
        .send(
            reqwest::Method::POST,
            &format!("/v1/jobs/{poison}/retry"),
            &serde_json::Value::Null,
            &[],
        )
        .await;
    assert_eq!(again.0, 200, "{}", again.1);
    let done = server.finished(&poison).await;
    assert_eq!(done["state"], "succeeded", "{done}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_that_ends_its_process_twice_on_sqlite() {
    set_aside(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_that_ends_its_process_twice_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        set_aside(database).await;
    }
}
