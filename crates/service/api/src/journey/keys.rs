//! Every route that takes an `Idempotency-Key`, if its process ends before and after its changes
//! are committed.

use std::time::Duration;

use reqwest::{RequestBuilder, StatusCode};
use serde_json::{Value, json};
use sistership_model::Zoo;
use sistership_store::CrashPoint;
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, SHIP, config, read};
use crate::Server;

/// Every path that a key may be sent to, by the document that describes the server.
fn keyed_routes() -> Vec<String> {
    let document = serde_json::to_value(crate::openapi()).unwrap();
    let keyed = |method: &Value| {
        let parameters = method["parameters"].as_array();
        parameters
            .is_some_and(|all| all.iter().any(|parameter| parameter["name"] == "Idempotency-Key"))
    };
    let mut found = Vec::new();
    for (path, methods) in document["paths"].as_object().unwrap() {
        let methods = methods.as_object().unwrap().iter().filter(|(_, method)| keyed(method));
        found.extend(methods.map(|(method, _)| format!("{method} {path}")));
    }
    found
}

/// Returns a request to a route, with everything that it needs in the archive.
async fn request(harness: &Harness, route: &str) -> RequestBuilder {
    let post = |path: &str| harness.client.post(harness.url(path));
    match route {
        "post /v1/laws" => {
            let zoo = Zoo::load_embedded().unwrap();
            let law = zoo.law_text("abkowitz").unwrap().to_owned();
            let name = law.lines().find(|line| line.starts_with("name:")).unwrap().to_owned();
            post("/v1/laws").header("content-type", "application/yaml").body(law.replacen(
                &name,
                "name: another-law",
                1,
            ))
        }
        "post /v1/ships" => post("/v1/ships").header("content-type", "application/yaml").body(SHIP),
        "post /v1/models/{model}/versions" => {
            let model = harness.get("/v1/ships/mariner/model").await["model"].clone();
            post("/v1/models/mariner/versions").json(&json!({ "model": model, "origin": "a test" }))
        }
        "post /v1/models/{model}/versions/{number}/signatures" => {
            post("/v1/models/mariner/versions/1/signatures")
                .json(&json!({ "role": "checked", "person": "Ann" }))
        }
        "post /v1/ships/{ship}/notes" => {
            post("/v1/ships/mariner/notes").json(&json!({ "text": "docked" }))
        }
        "post /v1/trials" => upload(harness, "again").await,
        "post /v1/families" => post("/v1/families")
            .json(&json!({ "name": "another", "foundation": "mariner", "members": ["mariner"] })),
        "post /v1/families/{family}/refinements" => {
            post("/v1/families/family/refinements").json(&json!({ "prior": "foundation" }))
        }
        "post /v1/refinements" => {
            post("/v1/refinements").json(&json!({ "ship": "mariner", "source": "mariner" }))
        }
        "post /v1/diagnoses" => post("/v1/diagnoses").json(&json!({ "model": "mariner" })),
        "post /v1/users" => post("/v1/users").json(&json!({ "name": "ann" })),
        "post /v1/branches" => post("/v1/branches").json(&json!({ "model": "mariner" })),
        other => panic!("say here how `{other}` is asked"),
    }
}

async fn upload(harness: &Harness, name: &str) -> RequestBuilder {
    let turn = if name == "again" { 20 } else { 35 };
    let asked = json!({ "model": "mariner", "manoeuvre": { "turn_deg": turn } });
    let (_, run) = harness.post("/v1/predictions", &asked).await;
    let post = harness.client.post(harness.url(&format!("/v1/trials?ship=mariner&name={name}")));
    post.header("content-type", "text/csv").body(super::harness::csv(&run["trajectory"]))
}

/// Sends it, and gives up once the process would have ended.
async fn ended_at(harness: &Harness, moment: CrashPoint, request: RequestBuilder) {
    let store = &harness.server.archive().store;
    store.end_at(moment);
    let sent = tokio::spawn(request.send());
    for _ in 0..1200 {
        if store.has_ended() {
            break;
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    // A little longer than the writes take to be committed or rolled back.
    tokio::time::sleep(Duration::from_millis(300)).await;
    let early = sent.is_finished();
    sent.abort();
    assert!(store.has_ended() && !early, "the request did not come to {moment:?}");
}

/// As after a minute.
async fn later(harness: &Harness) {
    let later = "UPDATE idempotency_keys SET created_us = created_us - 61000000, alive_us = NULL \
        WHERE status IS NULL";
    harness.database.execute_unchecked(later).await;
}

async fn keys_survive(database: TestDatabase) {
    let mut config = config(&database);
    config.workers = 0;
    let server = Server::start(config).await.unwrap();
    let harness = Harness { server, client: reqwest::Client::new(), database };
    let (status, made) = harness
        .post(
            "/v1/families",
            &json!({ "name": "family", "foundation": "mariner", "members": ["mariner"] }),
        )
        .await;
    assert_eq!(status, StatusCode::CREATED, "{made}");
    let (status, uploaded) = read(upload(&harness, "first").await.send().await.unwrap()).await;
    assert_eq!(status, StatusCode::CREATED, "{uploaded}");
    let routes = keyed_routes();
    assert!(routes.len() >= 8, "{routes:?}");
    for route in routes {
        survives(&harness, &route).await;
    }
}

async fn survives(harness: &Harness, route: &str) {
    let store = harness.server.archive().store.clone();
    let request = request(harness, route).await.header("idempotency-key", "key");
    let again = || request.try_clone().unwrap();
    let before = store.row_counts().await.unwrap();
    ended_at(harness, CrashPoint::BeforeCommit, again()).await;
    assert_eq!(
        store.row_counts().await.unwrap(),
        before,
        "{route}: nothing of what was not kept is there"
    );
    assert_eq!(
        again().send().await.unwrap().status(),
        StatusCode::CONFLICT,
        "{route}: it may still be carried out"
    );
    later(harness).await;
    ended_at(harness, CrashPoint::AfterCommit, again()).await;
    let kept = store.row_counts().await.unwrap();
    assert_ne!(kept, before, "{route}: what was kept is there");
    later(harness).await;
    let mut answers = Vec::new();
    for _ in 0..2 {
        let response = again().send().await.unwrap();
        assert_eq!(
            response.headers().get("idempotency-replayed").map(|value| value.as_bytes()),
            Some(&b"true"[..]),
            "{route}"
        );
        answers.push(read(response).await);
        assert_eq!(store.row_counts().await.unwrap(), kept, "{route}: no twin");
    }
    assert!(answers[0].0.is_success() && answers[0] == answers[1], "{route}: {answers:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn keys_survive_the_end_of_the_process_on_sqlite() {
    keys_survive(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn keys_survive_the_end_of_the_process_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        keys_survive(database).await;
    }
}
