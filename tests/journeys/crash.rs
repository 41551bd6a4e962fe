//! The server is killed in the middle of a refinement: what was acknowledged is there, and the job goes on or says why not.

use std::time::Duration;

use sistership_tests::server::TestServer;

use super::over_http::{create, refine, upload, verified};
use super::sea_trials::NAME;

async fn killed(mut server: TestServer) {
    create(&server).await;
    let uploaded = upload(&server).await;
    let first = server.finished(&refine(&server, "before").await).await;
    assert_eq!(first["state"], "succeeded", "{first}");
    let job = refine(&server, "during").await;
    while server.get(&format!("/v1/jobs/{job}")).await["state"] == "queued" {
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    server.kill();
    server.restart().await;
    let trials = server.get(&format!("/v1/trials?ship={NAME}")).await;
    let ids =
        |list: &serde_json::Value| list.as_array().expect("a list").iter().map(|trial| trial["id"].clone()).collect::<Vec<_>>();
    assert_eq!(ids(&trials["items"]), ids(&uploaded["trials"]), "every acknowledged trial is there");
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
