//! New trials say that a champion no longer holds: diagnosed by themselves, reported, verified,
//! promoted; the same on both databases.

use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::{Value, json};
use sistership_model::Trial;
use sistership_tests::binary;
use sistership_tests::server::{TestServer, json as answer};

use super::lacking::{EFFECT, NAME, OFFSET_DEG, further, manifest, ship, sound, trials};
use super::over_http::shapes;
use super::sea_trials::csv;

/// Creates the ship, whose document publishes a model: its first champion.
async fn create(server: &TestServer) {
    let request = server
        .request(Method::POST, "/v1/ships")
        .header("content-type", "application/yaml")
        .body(ship());
    let (status, created) = answer(request.send().await.expect("an answer")).await;
    assert_eq!((status, &created["condition"]["model"]), (201, &json!("unknown")), "{created}");
}

async fn upload(server: &TestServer, trials: &[Trial], query: &str) -> Value {
    let form = Form::new().text("manifest", manifest(trials));
    let form = trials.iter().fold(form, |form, trial| {
        form.part("file", Part::bytes(csv(trial)).file_name(trial.name.clone()))
    });
    let request = server.request(Method::POST, &format!("/v1/trials{query}")).multipart(form);
    let (status, uploaded) = answer(request.send().await.expect("an answer")).await;
    assert_eq!(status, 201, "{uploaded}");
    uploaded
}

async fn condition(server: &TestServer) -> Value {
    server.get(&format!("/v1/ships/{NAME}")).await["condition"].clone()
}

async fn page(server: &TestServer, path: &str) -> String {
    let response = server.request(Method::GET, path).send().await.expect("an answer");
    assert!(response.status().is_success(), "{path}: {}", response.status());
    response.text().await.expect("a page")
}

async fn alias(server: &TestServer, name: &str) -> (i64, String) {
    let path = format!("/v1/models/{NAME}/aliases/{name}");
    let response = server.request(Method::GET, &path).send().await.expect("an answer");
    let etag = response.headers()["etag"].to_str().expect("text").to_owned();
    let (_, alias) = answer(response).await;
    (alias["version"].as_i64().expect("a number"), etag)
}

async fn journey(server: TestServer) {
    create(&server).await;
    let uploaded = upload(&server, &trials(), "").await;
    let job = uploaded["diagnosis"].as_str().expect("a job follows").to_owned();
    let done = server.finished(&job).await;
    found(&done);
    does_not_hold(&server).await;
    reported(&server, done["result"]["report"].as_str().expect("a report")).await;
    versions(&server).await;
    shapes(&[("diagnosis", &done), ("condition", &condition(&server).await)]);
    let again = upload(&server, &trials(), "").await;
    assert_eq!(
        (again["new"].as_i64(), &again["diagnosis"]),
        (Some(0), &Value::Null),
        "nothing new, nothing to diagnose"
    );
    promoted(&server).await;
    asked_for(&server).await;
    refused(&server).await;
}

/// The automatic diagnosis named what is missing and made a version with it.
fn found(done: &Value) {
    assert_eq!(
        (&done["kind"], &done["state"]),
        (&json!("diagnosis"), &json!("succeeded")),
        "{done}"
    );
    let result = &done["result"];
    assert_eq!(
        (&result["verdict"], &result["effects"]),
        (&json!("effects"), &json!([EFFECT])),
        "{result}"
    );
    assert_eq!(
        (&result["diagnosed"], &result["version"]),
        (&json!(format!("{NAME}/1")), &json!(2)),
        "{result}"
    );
    let error = |which: &str| result[which]["psi"].as_f64().expect("an error");
    assert!(error("after") < 0.5 * error("before"), "{result}");
}

async fn does_not_hold(server: &TestServer) {
    let condition = condition(server).await;
    assert_eq!(
        (&condition["model"], &condition["effects"]),
        (&json!("does_not_hold"), &json!([EFFECT])),
        "{condition}"
    );
    assert_eq!(
        (&condition["version"], &condition["with_effects"]["number"]),
        (&json!(1), &json!(2)),
        "{condition}"
    );
    assert_eq!(condition["since"]["trial"], condition["trials"][0], "from the first trial on");
    assert_eq!(condition["against"], condition["trials"], "the effect is in all of them");
    let report = server.get(condition["found_by"]["report"].as_str().expect("a link")).await;
    assert_eq!(report["format"], "sistership-diagnosis/1", "{report}");
    let made = server.get(condition["with_effects"]["at"].as_str().expect("a link")).await;
    assert_eq!(
        (&made["version"]["number"], &made["version"]["method"]),
        (&json!(2), &json!("diagnosis")),
        "{made}"
    );
    assert_eq!(made["document"]["recipe"]["kind"], "diagnosis", "{made}");
    let page = page(server, &format!("/ships/{NAME}")).await;
    assert!(page.contains("Its model does not hold") && page.contains(EFFECT), "the page says so");
}

/// The report says it in one sentence, as data and as a page that stands alone.
async fn reported(server: &TestServer, id: &str) {
    let report = server.get(&format!("/v1/reports/{id}")).await;
    assert!(
        report["sentence"]
            .as_str()
            .is_some_and(|sentence| sentence.starts_with("Your model lacks")),
        "{report}"
    );
    let value =
        report["effects"][0]["parameters"]["offset_deg"]["value"].as_f64().expect("a value");
    assert!((value - OFFSET_DEG).abs() < 0.3, "{value}");
    let page = page(server, &format!("/v1/reports/{id}?format=html")).await;
    assert!(page.contains(report["sentence"].as_str().expect("text")) && page.contains("<svg"));
    assert!(!page.contains("<script src") && !page.contains("src="));
}

/// The new version has its parent, is the candidate, and derives again byte for byte; the champion
/// stays.
async fn versions(server: &TestServer) {
    let versions = server.get(&format!("/v1/models/{NAME}/versions")).await;
    let of = |number: i64| {
        versions["items"]
            .as_array()
            .and_then(|all| all.iter().find(|v| v["number"] == number))
            .cloned()
    };
    let (first, second) =
        (of(1).expect("the published one"), of(2).expect("the one with the effect"));
    assert_eq!(
        (&second["parent"], &second["method"]),
        (&first["id"], &json!("diagnosis")),
        "{versions}"
    );
    assert_eq!((alias(server, "champion").await.0, alias(server, "candidate").await.0), (1, 2));
    verified_on_the_command_line(server).await;
    let (status, verified) = server
        .send(Method::POST, &format!("/v1/models/{NAME}/versions/2/verify"), &json!({}), &[])
        .await;
    assert_eq!((status, &verified["identical"]), (200, &json!(true)), "{verified}");
}

/// On another thread: the client's connections close meanwhile, which it should see.
async fn verified_on_the_command_line(server: &TestServer) {
    let store = server.store_arguments();
    let verify = move || {
        let mut arguments = vec!["verify", "lacking/2", "--json"];
        arguments.extend(store.iter().map(String::as_str));
        binary::json(&arguments, 0)
    };
    let verification = tokio::task::spawn_blocking(verify).await.expect("it ends");
    assert_eq!(verification["identical"], true, "{verification}");
}

/// Who promotes the candidate has a model that holds.
async fn promoted(server: &TestServer) {
    let path = format!("/v1/models/{NAME}/aliases/champion");
    let body = json!({ "version": 2, "reason": "the rudder is off" });
    let before = ship_tag(server).await;
    let (_, etag) = alias(server, "champion").await;
    assert_eq!(server.send(Method::PUT, &path, &body, &[("if-match", &etag)]).await.0, 200);
    let condition = condition(server).await;
    assert_eq!(
        (&condition["model"], &condition["version"]),
        (&json!("holds"), &json!(2)),
        "{condition}"
    );
    assert_ne!(before, ship_tag(server).await, "who has the old condition gets the new one");
    let sailed = json!({ "model": NAME, "manoeuvre": { "turn_deg": 20 } });
    let (status, predicted) = server.send(Method::POST, "/v1/predictions", &sailed, &[]).await;
    assert_eq!(status, 200, "the champion with its effect sails: {predicted}");
}

async fn ship_tag(server: &TestServer) -> String {
    let response =
        server.request(Method::GET, &format!("/v1/ships/{NAME}")).send().await.expect("an answer");
    response.headers()["etag"].to_str().expect("text").to_owned()
}

/// A diagnosis that is asked for: of the champion on trials it has not seen, under a key, with
/// settings.
async fn asked_for(server: &TestServer) {
    let uploaded = upload(server, &further(), "?diagnose=false").await;
    assert_eq!(
        (uploaded["new"].as_i64(), &uploaded["diagnosis"]),
        (Some(2), &Value::Null),
        "{uploaded}"
    );
    let body = json!({ "model": NAME, "settings": { "least_step_s": 1.0, "most_effects": 1 } });
    let ask = async || {
        server.send(Method::POST, "/v1/diagnoses", &body, &[("Idempotency-Key", "one")]).await
    };
    let (status, job) = ask().await;
    assert_eq!(status, 202, "{job}");
    let done = server.finished(job["id"].as_str().expect("an id")).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    assert_eq!(ask().await.1["id"], job["id"], "the same key is the same job");
    let new: Vec<&Value> =
        uploaded["trials"].as_array().expect("trials").iter().map(|trial| &trial["id"]).collect();
    assert_eq!(
        done["request"]["trials"].as_array().map(|all| all.iter().collect()),
        Some(new),
        "only what version 2 has not seen"
    );
    assert_eq!(
        (&done["result"]["verdict"], &done["result"]["version"]),
        (&json!("complete"), &Value::Null),
        "{done}"
    );
    let condition = condition(server).await;
    assert_eq!(condition["model"], "holds", "{condition}");
    assert_eq!(
        condition["since"]["trial"], condition["trials"][0],
        "it has held since the trials that it came of"
    );
    assert_eq!(condition["trials"].as_array().map(Vec::len), Some(5), "{condition}");
    assert!(page(server, &format!("/ships/{NAME}")).await.contains("Its model holds"));
    let versions = server.get(&format!("/v1/models/{NAME}/versions")).await;
    assert_eq!(versions["items"].as_array().map(Vec::len), Some(2), "nothing found, no version");
}

/// What cannot be diagnosed is refused at once and by name.
async fn refused(server: &TestServer) {
    let cases = [
        (json!({}), "model"),
        (json!({ "model": "nobody" }), "nobody"),
        (json!({ "model": NAME, "trails": [] }), "trails"),
        (json!({ "model": NAME, "trials": [] }), "trials"),
        (json!({ "model": NAME, "trials": ["x"] }), "trials[0]"),
        (json!({ "model": "mariner" }), "has no trials"),
        (json!({ "model": NAME, "settings": { "slack": -1.0 } }), "settings.slack"),
        (json!({ "model": NAME, "settings": { "slak": 0.1 } }), "slak"),
        (json!({ "model": NAME, "settings": { "most_effects": 9 } }), "settings.most_effects"),
    ];
    for (body, says) in cases {
        let (status, problem) = server.send(Method::POST, "/v1/diagnoses", &body, &[]).await;
        let detail = problem["detail"].as_str().unwrap_or_default();
        assert!(status == 422 && detail.contains(says), "{body}: {status} {problem}");
    }
    let other = json!({ "model": NAME });
    assert_eq!(
        server.send(Method::POST, "/v1/diagnoses", &other, &[("Idempotency-Key", "one")]).await.0,
        422
    );
    let wish =
        server.request(Method::POST, &format!("/v1/trials?ship={NAME}&name=a.csv&diagnose=maybe"));
    let (status, problem) = answer(
        wish.header("content-type", "text/csv").body("t_s\n0\n").send().await.expect("an answer"),
    )
    .await;
    assert_eq!(status, 400, "{problem}");
}

/// Trials on which the champion holds are diagnosed too.
async fn sound_trials(server: TestServer) {
    create(&server).await;
    let uploaded = upload(&server, &sound(), "").await;
    let done = server.finished(uploaded["diagnosis"].as_str().expect("a job follows")).await;
    assert_eq!(
        (&done["result"]["verdict"], &done["result"]["version"]),
        (&json!("complete"), &Value::Null),
        "{done}"
    );
    assert_eq!(condition(&server).await["model"], "holds");
    let candidate = server.get(&format!("/v1/models/{NAME}/aliases/candidate")).await;
    assert_eq!(candidate["status"], 404, "no version, no candidate");
}

/// Uploads one trial and waits until it is diagnosed; returns its id and the job's result.
async fn diagnosed(server: &TestServer, trial: Trial) -> (Value, Value) {
    let uploaded = upload(server, &[trial], "").await;
    let done = server.finished(uploaded["diagnosis"].as_str().expect("a job follows")).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    (uploaded["trials"][0]["id"].clone(), done["result"].clone())
}

/// Trials of a damaged ship uploaded one by one, then a clean one: that alone is complete, and does
/// not clear the others.
async fn one_by_one(server: TestServer) {
    create(&server).await;
    let (first, alone) = diagnosed(&server, trials().remove(0)).await;
    assert_eq!(alone["verdict_of_new"], Value::Null, "nothing came before it: {alone}");
    for trial in trials().split_off(1) {
        let (_, both) = diagnosed(&server, trial).await;
        assert_ne!(both["verdict_of_new"], "complete", "{both}");
    }
    let (last, both) = diagnosed(&server, sound().remove(0)).await;
    assert_eq!(both["verdict_of_new"], "complete", "{both}");
    assert_eq!(both["trials"].as_array().map(Vec::len), Some(4), "all trials: {both}");
    let condition = condition(&server).await;
    assert_eq!(condition["model"], "does_not_hold", "{condition}");
    assert_eq!(condition["since"]["trial"], first, "{condition}");
    assert_eq!(condition["diagnoses"].as_array().map(Vec::len), Some(5), "{condition}");
    assert_eq!(condition["trials"][3], last, "{condition}");
    let name = condition["since"]["name"].as_str().expect("a name");
    let says = format!("does not hold since the trial {name}");
    assert!(condition["sentence"].as_str().is_some_and(|text| text.contains(&says)), "{condition}");
    assert!(page(&server, &format!("/ships/{NAME}")).await.contains(&says));
    assert!(page(&server, "/").await.contains("does not hold"), "the fleet says the same");
}

#[tokio::test]
async fn one_clean_trial_does_not_clear_three_of_a_damaged_ship() {
    one_by_one(TestServer::sqlite().await).await;
}

#[tokio::test]
async fn diagnosis_on_sqlite() {
    journey(TestServer::sqlite().await).await;
}

#[tokio::test]
async fn diagnosis_on_postgres() {
    if let Some(server) = TestServer::postgres().await {
        journey(server).await;
    }
}

#[tokio::test]
async fn a_champion_that_holds() {
    sound_trials(TestServer::sqlite().await).await;
}
