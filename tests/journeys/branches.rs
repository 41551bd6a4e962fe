//! A learned branch from trials to a version that is queried like any other: over HTTP, and on
//! files.

use reqwest::Method;
use serde_json::{Value, json};
use sistership_model::version::sha256_hex;
use sistership_tests::binary;
use sistership_tests::server::TestServer;

use super::over_http::{create, refine_weakly, upload, verified};
use super::sea_trials::{NAME, csv, manifest, ship, trials};

/// The error of a refused request: its status and the field at fault.
async fn refused(server: &TestServer, path: &str, body: &Value) -> (u16, String) {
    let (status, problem) = server.send(Method::POST, path, body, &[]).await;
    (status, problem["errors"][0]["field"].as_str().unwrap_or_default().to_owned())
}

/// Trains a branch beside the champion, and gives what the job ended with.
async fn trained(server: &TestServer, body: &Value) -> Value {
    let (status, job) = server.send(Method::POST, "/v1/branches", body, &[]).await;
    assert_eq!(status, 202, "{job}");
    let done = server.finished(job["id"].as_str().expect("an id")).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    done["result"].clone()
}

async fn journey(server: TestServer) {
    assert_eq!(server.send(Method::DELETE, "/v1/ships/sr108", &Value::Null, &[]).await.0, 204);
    create(&server).await;
    upload(&server).await;
    let job = refine_weakly(&server, "first").await;
    assert_eq!(server.finished(&job).await["state"], "succeeded");
    let settings = json!({ "kind": "kernels" });
    let made = trained(&server, &json!({ "model": NAME, "settings": settings })).await;
    assert_eq!((&made["version"], &made["alias"]), (&json!(2), &json!("candidate")), "{made}");
    assert_eq!(made["branch"]["mode"], "parallel");
    assert!(made["judgement"]["share"].as_f64() > Some(0.0), "{made}");
    verified(&server, 2).await;
    predicted(&server).await;
    weights(&server, &made["branch"]["weights_sha256"]).await;
    reported(&server, &made["report"]).await;
    champion(&server).await;
    bad_requests(&server).await;
    intact(&server).await;
}

/// A prediction says that a branch took part, and how much.
async fn predicted(server: &TestServer) {
    let path = "/v1/predictions";
    let ask = |model: String| json!({ "model": model, "manoeuvre": { "turn_deg": 12 } });
    let (_, alone) = server.send(Method::POST, path, &ask(format!("{NAME}/1")), &[]).await;
    let (status, both) = server.send(Method::POST, path, &ask(format!("{NAME}/2")), &[]).await;
    assert_eq!((status, both["branch"]["kind"].as_str()), (200, Some("kernel ridge")), "{both}");
    assert!(both["branch_share"].as_f64() > Some(0.1), "{}", both["branch_share"]);
    assert!(alone["branch"].is_null() && alone["branch_share"].is_null());
    assert_ne!(alone["trajectory"]["y_m"], both["trajectory"]["y_m"]);
}

/// The weights can be had, byte for byte.
async fn weights(server: &TestServer, named: &Value) {
    let of = |number: i64| format!("/v1/models/{NAME}/versions/{number}/weights");
    let got = server.request(Method::GET, &of(2)).send().await.expect("an answer");
    let bytes = got.bytes().await.expect("bytes");
    assert_eq!(json!(sha256_hex(&bytes)), *named);
    assert_eq!(server.get(&of(1)).await["status"], 404);
}

async fn reported(server: &TestServer, report: &Value) {
    let path = format!("/v1/reports/{}?format=html", report.as_str().expect("a report"));
    let page = server.request(Method::GET, &path).send().await.expect("an answer");
    let page = page.text().await.expect("a page");
    assert!(page.contains("kernel ridge, parallel") && page.contains("Share"), "{page}");
}

/// As champion it is answered, and a refinement starts from its law.
async fn champion(server: &TestServer) {
    let path = format!("/v1/models/{NAME}/aliases/champion");
    let seen = server.request(Method::GET, &path).send().await.expect("an answer");
    let etag = seen.headers()["etag"].to_str().expect("text").to_owned();
    let body = json!({ "version": 2, "reason": "the journey" });
    assert_eq!(server.send(Method::PUT, &path, &body, &[("if-match", &etag)]).await.0, 200);
    let champion = server.get(&format!("/v1/ships/{NAME}/model")).await;
    assert_eq!(champion["model"]["branch"]["mode"], "parallel", "{}", champion["version"]);
    assert_eq!(champion["version"]["method"], "branch-kernel-ridge-parallel");
    let again = refine_weakly(server, "second").await;
    assert_eq!(server.finished(&again).await["state"], "succeeded");
}

async fn bad_requests(server: &TestServer) {
    let path = "/v1/branches";
    let with = |settings: Value| json!({ "model": format!("{NAME}/1"), "settings": settings });
    for (body, field) in [
        (with(json!({ "kind": "oracle" })), "settings.kind"),
        (with(json!({ "kind": "forest", "fade": 9 })), "settings.fade"),
        (with(json!({ "kind": "forest", "window_s": -1 })), "settings.window_s"),
    ] {
        assert_eq!(refused(server, path, &body).await, (422, field.to_owned()), "{body}");
    }
    let mut model = server.get(&format!("/v1/ships/{NAME}/model")).await["model"].clone();
    model["branch"]["weights_sha256"] = json!("0".repeat(64));
    let path = format!("/v1/models/{NAME}/versions");
    let foreign = refused(server, &path, &json!({ "model": model, "origin": "elsewhere" })).await;
    assert_eq!(foreign, (422, "model.branch.weights_sha256".to_owned()));
}

/// `fsck` finds nothing, and `gc` takes nothing away.
async fn intact(server: &TestServer) {
    for (command, key, expected) in [("fsck", "clean", json!(true)), ("gc", "removed", json!([]))] {
        let mut arguments = vec![command.to_owned(), "--json".to_owned()];
        if command == "gc" {
            arguments.extend(["--grace-h", "0"].map(str::to_owned));
        }
        arguments.extend(server.store_arguments());
        let run =
            move || binary::json(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), 0);
        let said = tokio::task::spawn_blocking(run).await.expect("an end");
        assert_eq!(said[key], expected, "{said}");
    }
}

#[tokio::test]
async fn a_branch_is_a_version_like_any_other_on_sqlite() {
    journey(TestServer::sqlite().await).await;
}

#[tokio::test]
async fn a_branch_is_a_version_like_any_other_on_postgres() {
    if let Some(server) = TestServer::postgres().await {
        journey(server).await;
    }
}

/// What is said on standard error by a call that ends so.
fn said(arguments: &[&str], status: i32) -> String {
    let ended = binary::run(arguments);
    let message = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(status), "{message}");
    message
}

#[test]
fn a_branch_is_trained_and_sailed_on_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let sailed = trials();
    for trial in &sailed {
        std::fs::write(folder.path().join(&trial.name), csv(trial)).expect("written");
    }
    let path = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(path("trials.yaml"), manifest(&sailed)).expect("written");
    std::fs::write(path("ship.yaml"), ship()).expect("written");
    let (ship, trials, model, both) =
        (path("ship.yaml"), path("trials.yaml"), path("model.yaml"), path("both.yaml"));
    let refine = ["refine", "--ship", &ship, "--source", "mariner", "--trials", &trials];
    binary::json(&[&refine[..], &["--out", &model, "--json"]].concat(), 0);
    let branch = ["branch", "--model", &model, "--trials", &trials, "--out", &both, "--json"];
    let made = binary::json(&[&branch[..], &["--kind", "boosted"]].concat(), 0);
    assert_eq!(made["branch"], json!({ "kind": "boosted trees", "mode": "parallel" }), "{made}");
    assert_eq!(made["judgement"]["trials"].as_array().map(Vec::len), Some(4), "{made}");
    let weights = std::fs::read(path("both.weights.json")).expect("weights beside the model");
    assert_eq!(made["weights_sha256"], json!(sha256_hex(&weights)));
    let simulate = |model: &str, status: i32| {
        let restarted = ["--restart-s", "100", "--json"];
        let call = ["simulate", "--model", model, "--trials", &trials];
        binary::json(&[&call[..], &restarted].concat(), status)
    };
    let (alone, joined) = (simulate(&model, 0), simulate(&both, 0));
    let error = |said: &Value| said["all"]["standardised_mse"].as_f64().expect("an error");
    assert!(error(&joined) < error(&alone), "{} {}", joined["all"], alone["all"]);
    assert!(joined["all"]["branch_share"].as_f64() > Some(0.5), "{}", joined["all"]);
    assert!(alone["branch"].is_null() && joined["branch"]["kind"] == "boosted trees");
    let turn = binary::json(&["manoeuvre", "--model", &both, "--turn", "12", "--json"], 0);
    assert!(turn["branch_share"]["turn 12 deg"].is_f64(), "{turn}");
    refusals(&both, &trials, &path("both.weights.json"), &weights);
}

/// What does not go with such a model is refused with the place.
fn refusals(both: &str, trials: &str, beside: &str, weights: &[u8]) {
    let retrained = said(&["branch", "--model", both, "--trials", trials, "--kind", "boosted"], 0);
    assert!(retrained.contains("the learned correction is not used"), "{retrained}");
    let sail = ["manoeuvre", "--model", both, "--turn", "12"];
    std::fs::write(beside, &weights[1..]).expect("written");
    let damaged = said(&sail, 1);
    assert!(damaged.contains("branch.weights_sha256: is"), "{damaged}");
    std::fs::remove_file(beside).expect("removed");
    let missing = said(&sail, 1);
    assert!(missing.contains("both.yaml") && missing.contains("both.weights.json"), "{missing}");
    let wrong = said(&["branch", "--model", both, "--trials", trials, "--fade", "9"], 2);
    assert!(wrong.contains("--fade"), "{wrong}");
}
