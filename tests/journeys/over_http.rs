//! One journey over HTTP, the same on both databases.

use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::{Value, json};
use sistership_model::Trial;
use sistership_tests::binary;
use sistership_tests::server::{TestServer, json as answer};
use sistership_tests::shape;

use super::sea_trials::{NAME, csv, few, manifest, ship, trials};

/// Creates the ship.
pub async fn create(server: &TestServer) {
    let request = server
        .request(Method::POST, "/v1/ships")
        .header("content-type", "application/yaml")
        .body(ship());
    let (status, created) = answer(request.send().await.expect("an answer")).await;
    assert_eq!((status, created["name"].as_str()), (201, Some(NAME)), "{created}");
}

/// Uploads its trials by manifest.
pub async fn upload(server: &TestServer) -> Value {
    sent(server, &trials()).await
}

/// Uploads few and short ones.
pub async fn upload_few(server: &TestServer) -> Value {
    sent(server, &few()).await
}

async fn sent(server: &TestServer, trials: &[Trial]) -> Value {
    let form = Form::new().text("manifest", manifest(trials));
    let form = trials.iter().fold(form, |form, trial| {
        form.part("file", Part::bytes(csv(trial)).file_name(trial.name.clone()))
    });
    let (status, uploaded) = answer(
        server.request(Method::POST, "/v1/trials").multipart(form).send().await.expect("an answer"),
    )
    .await;
    assert_eq!((status, uploaded["new"].as_u64()), (201, Some(trials.len() as u64)), "{uploaded}");
    uploaded
}

/// Asks for a refinement under a key; gives the job's id.
pub async fn refine(server: &TestServer, key: &str) -> String {
    submit(server, key, &json!({ "ship": NAME, "source": "auto" })).await
}

/// Submits a refinement from the nearest ship by one candidate of a named estimator, with few draws
/// of its bands and a noise model learned on one trial, where the refinement is not what is looked
/// at.
pub async fn refine_weakly(server: &TestServer, key: &str) -> String {
    let settings = json!({
        "method": "weak", "families": ["own"], "strengths": [1.0], "bands": { "samples": 10 },
        "calibration_samples": 1,
    });
    submit(server, key, &json!({ "ship": NAME, "source": "auto", "settings": settings })).await
}

async fn submit(server: &TestServer, key: &str, body: &Value) -> String {
    let (status, job) =
        server.send(Method::POST, "/v1/refinements", body, &[("Idempotency-Key", key)]).await;
    assert_eq!(status, 202, "{job}");
    job["id"].as_str().expect("an id").to_owned()
}

async fn journey(server: TestServer) {
    // SR108 made the trials: it must not be its own source.
    assert_eq!(server.send(Method::DELETE, "/v1/ships/sr108", &Value::Null, &[]).await.0, 204);
    create(&server).await;
    upload(&server).await;
    assert_eq!(server.get(&format!("/v1/ships/{NAME}/model")).await["status"], 404, "no model yet");
    let job = refine(&server, "first").await;
    assert_eq!(refine(&server, "first").await, job, "the same key is the same job");
    let done = server.finished(&job).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    assert_eq!(
        (done["result"]["version"].as_i64(), done["result"]["alias"].as_str()),
        (Some(1), Some("champion")),
        "{done}"
    );
    let champion = server.get(&format!("/v1/ships/{NAME}/model")).await;
    assert_eq!(champion["version"]["number"], 1, "{champion}");
    improved(&done["result"]["held_out"]);
    aliases(&server).await;
    repeated(&server).await;
    verified(&server, 1).await;
    across_laws(&server).await;
    let report = done["result"]["report"].as_str().expect("a report");
    let page = server
        .request(Method::GET, &format!("/v1/reports/{report}?format=html"))
        .send()
        .await
        .expect("an answer");
    assert!(page.text().await.expect("a page").contains("<svg"), "the report has plots");
    shapes(&[
        ("job", &done),
        ("champion", &champion),
        ("report", &server.get(&format!("/v1/reports/{report}")).await),
    ]);
}

/// What scripts depend on: the paths and types of the answers, held by snapshots
/// (`INSTA_UPDATE=always` rewrites them).
pub fn shapes(answers: &[(&str, &Value)]) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for (name, answer) in answers {
            insta::assert_snapshot!(*name, shape::of(answer));
        }
    });
}

/// The refined model is better on manoeuvres left out.
fn improved(held_out: &Value) {
    for channel in ["u", "r", "psi"] {
        let of = |which: &str| held_out[which][channel].as_f64().expect("an error");
        assert!(of("refined") < of("source"), "{channel}: {held_out}");
    }
}

/// An alias moves only for who has seen where it stands.
async fn aliases(server: &TestServer) {
    let path = format!("/v1/models/{NAME}/aliases/harbour");
    let body = json!({ "version": 1, "reason": "the journey" });
    assert_eq!(server.send(Method::PUT, &path, &body, &[]).await.0, 428);
    let created = server
        .request(Method::PUT, &path)
        .header("if-none-match", "*")
        .json(&body)
        .send()
        .await
        .expect("an answer");
    let etag = created.headers()["etag"].to_str().expect("text").to_owned();
    assert!(created.status().is_success());
    assert_eq!(server.send(Method::PUT, &path, &body, &[("if-match", &etag)]).await.0, 200);
    let (status, problem) = server.send(Method::PUT, &path, &body, &[("if-match", &etag)]).await;
    assert_eq!(status, 412, "a stale ETag: {problem}");
    let history = server.get(&format!("{path}/history")).await;
    assert_eq!(history["items"].as_array().map(Vec::len), Some(2), "{history}");
}

/// A second refinement is a candidate; repeating its request makes no third.
async fn repeated(server: &TestServer) {
    let job = refine(server, "second").await;
    let done = server.finished(&job).await;
    assert_eq!(
        (done["result"]["version"].as_i64(), done["result"]["alias"].as_str()),
        (Some(2), Some("candidate")),
        "{done}"
    );
    assert_eq!(refine(server, "second").await, job);
    let body = json!({ "ship": NAME, "source": "mariner" });
    assert_eq!(
        server
            .send(Method::POST, "/v1/refinements", &body, &[("Idempotency-Key", "second")])
            .await
            .0,
        422
    );
    let versions = server.get(&format!("/v1/models/{NAME}/versions")).await;
    assert_eq!(versions["items"].as_array().map(Vec::len), Some(2), "{versions}");
}

/// The SR108's trials refine a polynomial, of which the MMG source of the KVLCC2 is the prior.
async fn across_laws(server: &TestServer) {
    let body = json!({ "ship": NAME, "source": "kvlcc2", "law": "low-sped" });
    let (status, refused) = server.send(Method::POST, "/v1/refinements", &body, &[]).await;
    assert_eq!((status, refused["errors"][0]["field"].as_str()), (422, Some("law")), "{refused}");
    let body = json!({ "ship": NAME, "source": "kvlcc2", "law": "low-speed",
        "settings": { "method": "weak", "strengths": [1.0, 0.1] } });
    let (status, job) = server.send(Method::POST, "/v1/refinements", &body, &[]).await;
    assert_eq!(status, 202, "{job}");
    let done = server.finished(job["id"].as_str().expect("an id")).await;
    assert_eq!(
        (done["state"].as_str(), done["result"]["version"].as_i64()),
        (Some("succeeded"), Some(3)),
        "{done}"
    );
    let version = server.get(&format!("/v1/models/{NAME}/versions/3")).await;
    assert_eq!(
        version["document"]["recipe"]["across"]["law"], "low-speed",
        "{}",
        version["document"]["recipe"]
    );
    assert_eq!(version["document"]["model"]["law"], "low-speed");
    verified(server, 3).await;
}

/// `sistership verify` derives the version again from its recipe, byte for byte.
pub async fn verified(server: &TestServer, number: i64) {
    let arguments: Vec<String> =
        ["verify".to_owned(), format!("{NAME}/{number}"), "--json".to_owned()]
            .into_iter()
            .chain(server.store_arguments())
            .collect();
    // Beside the client, which must notice that the server closes connections which rest.
    let verify = move || binary::json(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), 0);
    let verification = tokio::task::spawn_blocking(verify).await.expect("a verification");
    assert_eq!(verification["identical"], true, "{verification}");
}

#[tokio::test]
async fn journey_on_sqlite() {
    journey(TestServer::sqlite().await).await;
}

#[tokio::test]
async fn journey_on_postgres() {
    if let Some(server) = TestServer::postgres().await {
        journey(server).await;
    }
}
