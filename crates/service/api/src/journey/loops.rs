//! From a ship to a refined champion that verifies.

use reqwest::StatusCode;
use serde_json::json;
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, config, read};
use crate::Server;

#[tokio::test(flavor = "multi_thread")]
async fn the_loop_on_sqlite() {
    the_loop(Harness::on(TestDatabase::new_sqlite()).await).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn the_loop_on_postgres() {
    let Some(database) = TestDatabase::new_postgres().await else { return };
    the_loop(Harness::on(database).await).await;
}

async fn the_loop(harness: Harness) {
    assert_eq!(harness.create_ship().await.0, StatusCode::CREATED);
    assert_eq!(
        harness.create_ship().await.0,
        StatusCode::CREATED,
        "the same key again is answered again"
    );
    assert!(
        harness.get("/v1/ships/demo-ship/model").await["detail"]
            .as_str()
            .unwrap()
            .contains("upload trials")
    );
    let (status, uploaded) = harness.upload_trials().await;
    assert_eq!((status, &uploaded["new"]), (StatusCode::CREATED, &json!(4)), "{uploaded}");
    assert_eq!(harness.upload_trials().await.1["new"], 0);
    let source = refine(&harness, "auto").await["result"]["source"].clone();
    assert_eq!(source, "sr108/1", "the most similar ship is itself");
    let job = refine(&harness, "mariner").await;
    assert_eq!(
        (&job["result"]["version"], &job["result"]["alias"]),
        (&json!(2), &json!("candidate"))
    );
    let errors = &job["result"]["held_out"];
    assert!(errors["refined"]["r"].as_f64() < errors["source"]["r"].as_f64(), "{errors}");
    champion(&harness).await;
    verified(&harness).await;
    pages(&harness, job["result"]["report"].as_str().unwrap()).await;
    harness.server.stop().await;
}

async fn refine(harness: &Harness, source: &str) -> serde_json::Value {
    let (status, job) =
        harness.post("/v1/refinements", &json!({ "ship": "demo-ship", "source": source })).await;
    assert_eq!(status, StatusCode::ACCEPTED, "{job}");
    let job = harness.follow(job["id"].as_str().unwrap()).await;
    assert_eq!(job["state"], "succeeded", "{job}");
    job
}

/// The alias moves by compare-and-swap, and the champion is the version it refers to.
async fn champion(harness: &Harness) {
    let url = harness.url("/v1/models/demo-ship/aliases/champion");
    let put = |tag: &'static str| {
        harness
            .client
            .put(&url)
            .header("if-match", tag)
            .json(&json!({ "version": 2, "reason": "better" }))
    };
    assert_eq!(put("\"1\"").send().await.unwrap().status(), StatusCode::OK);
    assert_eq!(put("\"1\"").send().await.unwrap().status(), StatusCode::PRECONDITION_FAILED);
    let champion = harness.get("/v1/ships/demo-ship/model").await;
    assert_eq!(
        (&champion["version"]["number"], &champion["model"]["law"]),
        (&json!(2), &json!("abkowitz"))
    );
    let yaml = harness
        .client
        .get(harness.url("/v1/ships/demo-ship/model?format=yaml"))
        .send()
        .await
        .unwrap()
        .text()
        .await
        .unwrap();
    assert!(yaml.starts_with("kind: model"));
}

async fn verified(harness: &Harness) {
    // Changing the ship and deleting trials keeps versions derivable that were made with them.
    let renamed = super::harness::SHIP.replace("Demo ship", "Renamed");
    let put = harness.client.put(harness.url("/v1/ships/demo-ship")).header("if-match", "\"1\"");
    let (status, _) =
        read(put.header("content-type", "application/yaml").body(renamed).send().await.unwrap())
            .await;
    assert_eq!(status, StatusCode::OK);
    for version in ["demo-ship/versions/1", "demo-ship/versions/2", "mariner/versions/1"] {
        let (_, verified) = harness.post(&format!("/v1/models/{version}/verify"), &json!({})).await;
        assert_eq!(verified["identical"], true, "{verified}");
    }
    let checked = sistership_jobs::verify::verify_version(harness.server.archive(), "demo-ship", 2)
        .await
        .unwrap();
    assert!(checked.identical && checked.made_by.is_some());
}

async fn pages(harness: &Harness, report: &str) {
    for page in
        ["/".to_owned(), "/ships/demo-ship".to_owned(), format!("/v1/reports/{report}?format=html")]
    {
        let response = harness.client.get(harness.url(&page)).send().await.unwrap();
        assert!(
            response.headers()["content-security-policy"]
                .to_str()
                .unwrap()
                .contains("default-src 'none'")
        );
        assert!(response.text().await.unwrap().contains("demo-ship"), "{page}");
    }
    assert_eq!(
        harness.get(&format!("/v1/reports/{report}")).await["format"],
        "sistership-report/1"
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn two_servers_start_on_one_empty_database() {
    for database in
        [Some(TestDatabase::new_sqlite()), TestDatabase::new_postgres().await].into_iter().flatten()
    {
        let (one, two) =
            tokio::join!(Server::start(config(&database)), Server::start(config(&database)));
        let (one, two) = (one.unwrap(), two.unwrap());
        let champion = two.archive().store.aliases().get("mariner", "champion").await.unwrap();
        assert_eq!((champion.version_number, champion.revision), (1, 1));
        let versions = one
            .archive()
            .store
            .versions()
            .list("mariner", &sistership_store::PageRequest::first_page(10))
            .await
            .unwrap();
        assert_eq!(versions.items.len(), 1);
        one.stop().await;
        two.stop().await;
    }
}
