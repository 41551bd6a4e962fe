//! A refinement that names nothing, of a ship whose rudder stalls: a learned branch wins on trials
//! left out, and is trained by a job of its own beside the refined version.

use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::{Value, json};
use sistership_tests::server::{TestServer, json as answer};
use sistership_tests::truth::container::container;
use sistership_tests::truth::files::{vessel, write_trials};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::PROGRAMME;
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::stalled::Stalled;
use sistership_tests::truth::trials;

/// The ship with its twelve trials; its name.
async fn uploaded(server: &TestServer) -> String {
    let ship = Stalled(container());
    let name = ship.dimensions().name.clone();
    let request = server.request(Method::POST, "/v1/ships");
    let request =
        request.header("content-type", "application/yaml").body(vessel(ship.dimensions())).send();
    assert_eq!(answer(request.await.expect("an answer")).await.0, 201);
    let seen = trials(&ship, &PROGRAMME, &Instruments::of(&ship), 1);
    let folder = tempfile::tempdir().expect("a folder");
    let manifest = write_trials(folder.path(), &name, &seen.iter().collect::<Vec<_>>());
    let text = std::fs::read_to_string(manifest).expect("a manifest");
    let file = |name: &str| std::fs::read(folder.path().join(name)).expect("a file");
    let form = seen.iter().fold(Form::new().text("manifest", text), |form, trial| {
        form.part("file", Part::bytes(file(&trial.name)).file_name(trial.name.clone()))
    });
    let request = server.request(Method::POST, "/v1/trials").multipart(form);
    let (status, uploaded) = answer(request.send().await.expect("an answer")).await;
    assert_eq!(status, 201, "{uploaded}");
    name
}

async fn result(server: &TestServer, job: &Value) -> Value {
    let done = server.finished(job.as_str().expect("an id")).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    done["result"].clone()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_branch_that_wins_is_trained_beside_the_refined_version() {
    let server = TestServer::sqlite().await;
    let name = uploaded(&server).await;
    let held_out = json!({ "held_out": ["turn_-15.csv"] });
    let body = json!({ "ship": name, "settings": held_out });
    let (status, job) = server.send(Method::POST, "/v1/refinements", &body, &[]).await;
    assert_eq!(status, 202, "{job}");
    let refined = result(&server, &job["id"]).await;
    let reason = &refined["ladder"]["branch"]["reason"];
    assert!(refined["branch_job"].is_null(), "eleven trials are too few: {refined}");
    assert!(reason.as_str().is_some_and(|why| why.contains("11 trials")), "{reason}");
    let (_, job) =
        server.send(Method::POST, "/v1/refinements", &json!({ "ship": name }), &[]).await;
    let refined = result(&server, &job["id"]).await;
    let branch = &refined["ladder"]["branch"];
    if branch["taken"].is_null() {
        // The ship is at the edge of what twelve trials prove: then the reason says why, and nothing
        // is trained.
        assert!(branch["reason"].as_str().is_some_and(|why| !why.is_empty()), "{branch}");
        assert!(refined["branch_job"].is_null(), "{refined}");
        return;
    }
    let trained = result(&server, &refined["branch_job"]).await;
    assert_eq!(trained["foundation"], json!(format!("{name}/{}", refined["version"])));
    // The training compares with a foundation that has seen the trials, which favours that one.
    assert!(trained["wins"].is_boolean(), "{trained}");
    assert_eq!(trained["alias"], json!("candidate"));
    assert_eq!(trained["judgement"]["trials"].as_array().map(Vec::len), Some(12));
}
