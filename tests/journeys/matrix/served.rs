//! What a server does with a version, for versions of every kind: a refinement with a source, by a
//! law without one, by the prior of a population, a correction learned beside one, and what a
//! diagnosis makes of it.

use reqwest::Method;
use serde_json::{Value, json};
use sistership_tests::binary;
use sistership_tests::server::TestServer;

use crate::over_http::{create, refine_weakly, upload, verified};
use crate::sea_trials::NAME;

/// The number of a version, and whether it has a learned correction.
type Made = (i64, bool);

async fn queued(server: &TestServer, path: &str, body: &Value) -> Value {
    let (status, job) = server.send(Method::POST, path, body, &[]).await;
    assert_eq!(status, 202, "{path} {body}: {job}");
    let done = server.finished(job["id"].as_str().expect("an id")).await;
    assert_eq!(done["state"], "succeeded", "{path} {body}: {done}");
    done["result"].clone()
}

fn number(result: &Value) -> i64 {
    result["version"].as_i64().unwrap_or_else(|| panic!("a version: {result}"))
}

/// A version of each kind.
async fn versions(server: &TestServer) -> Vec<Made> {
    let job = refine_weakly(server, "source").await;
    let mut made = vec![(number(&server.finished(&job).await["result"]), false)];
    let settings = json!({ "method": "weak", "families": ["own"], "strengths": [1.0],
        "bands": { "samples": 10 }, "calibration_samples": 1 });
    let of = |name: &str, value: Value| {
        let mut body = json!({ "ship": NAME, "settings": settings });
        body[name] = value;
        body
    };
    let law = of("law", json!("abkowitz"));
    let mut population = of("source", json!("kcs"));
    population["law"] = json!("abkowitz");
    population["settings"]["prior"] = json!("population");
    for body in [law, population] {
        made.push((number(&queued(server, "/v1/refinements", &body).await), false));
    }
    let foundation = format!("{NAME}/{}", made[0].0);
    let branch = json!({ "model": foundation, "settings": { "kind": "boosted" } });
    made.push((number(&queued(server, "/v1/branches", &branch).await), true));
    made
}

/// The version becomes the champion, so that what looks at champions looks at it.
async fn crowned(server: &TestServer, number: i64) {
    let path = format!("/v1/models/{NAME}/aliases/champion");
    let seen = server.request(Method::GET, &path).send().await.expect("an answer");
    let etag = seen.headers()["etag"].to_str().expect("text").to_owned();
    let body = json!({ "version": number, "reason": "the journey" });
    let (status, said) = server.send(Method::PUT, &path, &body, &[("if-match", &etag)]).await;
    assert_eq!(status, 200, "{said}");
}

async fn read(server: &TestServer, path: &str) -> Value {
    let said = server.get(path).await;
    assert!(said["status"].as_u64().is_none(), "{path}: {said}");
    said
}

/// What is asked of a version by its number.
async fn asked(server: &TestServer, version: i64, trial: &str) {
    let model = format!("{NAME}/{version}");
    read(server, &format!("/v1/compare?version={model}&version=mariner&trial={trial}")).await;
    read(server, &format!("/v1/models/{NAME}/versions/{version}/validation")).await;
    for format in ["c", "python", "matlab", "modelica", "fmu2", "fmu3", "ssp"] {
        let path = format!("/v1/models/{NAME}/versions/{version}/export?format={format}");
        let answer = server.request(Method::GET, &path).send().await.expect("an answer");
        assert_eq!(answer.status(), 200, "{model}: {format}");
    }
    let turn = json!({ "model": model, "manoeuvre": { "turn_deg": 20 } });
    let horizon = json!({ "model": model, "horizon": { "duration_s": 30, "draws": 4 } });
    for body in [turn, horizon] {
        let (status, said) = server.send(Method::POST, "/v1/predictions", &body, &[]).await;
        assert_eq!(status, 200, "{body}: {said}");
    }
    let session = json!({ "model": model });
    let (status, said) = server.send(Method::POST, "/v1/sessions", &session, &[]).await;
    assert_eq!(status, 201, "{said}");
    verified(server, version).await;
}

/// What is asked of a champion.
async fn of_champion(server: &TestServer, version: i64) {
    crowned(server, version).await;
    let drift = read(server, &format!("/v1/ships/{NAME}/drift")).await;
    assert!(drift["reason"].is_null() && drift["version"] == version, "{drift}");
    assert!(drift["trials"].as_array().is_some_and(|trials| trials.len() == 4), "{drift}");
    let settings =
        json!({ "method": "published", "bands": { "samples": 10 }, "calibration_samples": 1 });
    let body = json!({ "ship": NAME, "source": NAME, "settings": settings });
    queued(server, "/v1/refinements", &body).await;
    in_bulk(server, version).await;
}

/// It is refined as the only member of a family that is founded on it.
async fn in_bulk(server: &TestServer, version: i64) {
    let (name, foundation) = (format!("family-{version}"), format!("{NAME}/{version}"));
    let family = json!({ "name": name, "foundation": foundation, "members": [NAME] });
    let (status, said) = server.send(Method::POST, "/v1/families", &family, &[]).await;
    assert_eq!(status, 201, "{said}");
    let path = format!("/v1/families/{name}/refinements");
    let body = json!({ "prior": "foundation" });
    let (status, bulk) = server.send(Method::POST, &path, &body, &[]).await;
    assert_eq!(status, 202, "{bulk}");
    let path = format!("/v1/bulk-refinements/{}", bulk["id"].as_str().expect("an id"));
    while matches!(read(server, &path).await["state"].as_str(), Some("queued" | "running")) {
        tokio::time::sleep(std::time::Duration::from_millis(100)).await;
    }
    let ships = read(server, &format!("{path}/ships")).await;
    let outcome = ships["items"][0]["outcome"].as_str().unwrap_or_default().to_owned();
    assert!(["champion", "candidate", "unchanged"].contains(&&outcome[..]), "{version}: {ships}");
    read(server, &format!("/v1/families/{name}/drift")).await;
}

/// All of it goes to another store, where nothing is missing.
async fn moved(here: &TestServer) {
    let there = TestServer::sqlite().await;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("ship.bundle").display().to_string();
    let run = |server: &TestServer, arguments: &[&str]| {
        let all: Vec<String> =
            arguments.iter().map(|&a| a.to_owned()).chain(server.store_arguments()).collect();
        let done = binary::run(&all.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(done.status.success(), "{all:?}: {}", String::from_utf8_lossy(&done.stderr));
    };
    run(here, &["export", NAME, "--format", "bundle", "--out", &file]);
    run(&there, &["import", "--bundle", &file]);
    run(here, &["fsck"]);
    run(&there, &["fsck"]);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_server_takes_every_kind_of_version() {
    let server = TestServer::sqlite().await;
    assert_eq!(server.send(Method::DELETE, "/v1/ships/sr108", &Value::Null, &[]).await.0, 204);
    create(&server).await;
    let uploaded = upload(&server).await;
    let trial = uploaded["trials"][0]["id"].as_str().expect("an id");
    let mut made = versions(&server).await;
    let body = json!({ "model": format!("{NAME}/{}", made[3].0), "trials": [trial] });
    let found = queued(&server, "/v1/diagnoses", &body).await;
    // Where it finds effects, the version with them keeps the correction.
    made.extend(found["version"].as_i64().map(|number| (number, true)));
    for (version, has_correction) in &made {
        let stored = read(&server, &format!("/v1/models/{NAME}/versions/{version}/document")).await;
        assert_eq!(!stored["model"]["branch"].is_null(), *has_correction, "{version}");
        asked(&server, *version, trial).await;
        of_champion(&server, *version).await;
    }
    for (version, _) in &made[..3] {
        let body = json!({ "model": format!("{NAME}/{version}"), "trials": [trial] });
        queued(&server, "/v1/diagnoses", &body).await;
    }
    // A correction is trained beside the foundation of a version that has one.
    let body =
        json!({ "model": format!("{NAME}/{}", made[3].0), "settings": { "kind": "kernels" } });
    let again = queued(&server, "/v1/branches", &body).await;
    assert_eq!(again["foundation"], json!(format!("{NAME}/{}", made[0].0)), "{again}");
    moved(&server).await;
}
