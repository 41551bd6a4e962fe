//! Observability of a server: readiness and metrics.

use reqwest::StatusCode;
use serde_json::json;
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, config};
use crate::Server;

async fn text(harness: &Harness, path: &str) -> String {
    harness.client.get(harness.url(path)).send().await.unwrap().text().await.unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn the_metrics_tell_requests_jobs_and_sizes() {
    for database in
        [Some(TestDatabase::new_sqlite()), TestDatabase::new_postgres().await].into_iter().flatten()
    {
        let mut config = config(&database);
        config.workers = 0;
        let harness = Harness {
            server: Server::start(config).await.unwrap(),
            client: reqwest::Client::new(),
            database,
        };
        harness.create_ship().await;
        let uploaded = harness.upload_trials().await.1;
        assert_eq!(
            harness.post("/v1/refinements", &json!({ "ship": "demo-ship" })).await.0,
            StatusCode::ACCEPTED,
            "{uploaded}"
        );
        harness.get("/v1/ships/atlantis").await;
        let metrics = text(&harness, "/metrics").await;
        for line in [
            r#"sistership_http_requests_total{method="GET",route="/v1/ships/{ship}",status="404"} 1"#,
            r#"sistership_http_request_duration_seconds_count{method="POST",route="/v1/trials"} 1"#,
            r#"sistership_jobs{kind="refinement",state="queued"} 1"#,
            "sistership_object_store_objects 4",
            "# EOF",
        ] {
            assert!(metrics.lines().any(|other| other == line), "{line}: {metrics}");
        }
        let value = |name: &str| -> f64 {
            let line =
                metrics.lines().find_map(|line| line.strip_prefix(name)?.trim().parse().ok());
            line.unwrap_or_else(|| panic!("{name}: {metrics}"))
        };
        assert!(
            value("sistership_queue_age_seconds ") > 0.0
                && value("sistership_object_store_bytes ") > 1000.0
        );
        harness.server.stop().await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_server_without_its_objects_is_alive_but_not_ready() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    assert_eq!(harness.get("/readyz").await["status"], "ok");
    let data = harness.database.folder.path().join("data");
    std::fs::rename(&data, data.with_extension("unmounted")).unwrap();
    let unready = harness.get("/readyz").await;
    assert_eq!(unready["status"], 503, "{unready}");
    assert!(unready["detail"].as_str().unwrap().contains("object store"), "{unready}");
    assert_eq!(harness.get("/healthz").await["status"], "ok");
    std::fs::rename(data.with_extension("unmounted"), &data).unwrap();
    assert_eq!(harness.get("/readyz").await["status"], "ok");
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_server_that_has_lost_its_database_is_not_ready() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    harness.server.archive().store.close().await;
    let unready = harness.get("/readyz").await;
    assert!(
        unready["status"] == 503 && unready["detail"].as_str().unwrap().contains("database"),
        "{unready}"
    );
}
