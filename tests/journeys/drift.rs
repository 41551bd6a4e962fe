//! Drift of a champion on further trials of the same hull: below the limit that its condition has.

use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::Value;
use sistership_cli::sea_trials::TrialManoeuvre;
use sistership_jobs::condition::DRIFT_LIMIT;
use sistership_model::Trial;
use sistership_tests::server::{TestServer, json as answer};

use super::over_http::{create, refine_weakly, upload_few};
use super::sea_trials::{NAME, csv, manifest, sailed};

async fn upload_one(server: &TestServer, trial: &Trial) {
    let form = Form::new().text("manifest", manifest(std::slice::from_ref(trial)));
    let form = form.part("file", Part::bytes(csv(trial)).file_name(trial.name.clone()));
    let request = server.request(Method::POST, "/v1/trials").multipart(form);
    let (status, uploaded) = answer(request.send().await.expect("an answer")).await;
    assert_eq!(status, 201, "{uploaded}");
    let done = server.finished(uploaded["diagnosis"].as_str().expect("a job follows")).await;
    assert_eq!(done["state"], "succeeded", "{done}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_sound_ship_stays_below_the_limit_of_drift() {
    let server = TestServer::sqlite().await;
    create(&server).await;
    upload_few(&server).await;
    let job = refine_weakly(&server, "first").await;
    assert_eq!(server.finished(&job).await["state"], "succeeded");
    let programme = [TrialManoeuvre::Zigzag(15.0, 15.0), TrialManoeuvre::Turn(15.0)];
    for trial in sailed(&programme, 11) {
        upload_one(&server, &trial).await;
        let condition = server.get(&format!("/v1/ships/{NAME}")).await["condition"].clone();
        let ratio = condition["drift"]["ratio"].as_f64();
        println!("{}: drift {ratio:?}; {}", trial.name, condition["sentence"]);
        assert!(ratio.is_some_and(|ratio| ratio < DRIFT_LIMIT), "{condition}");
        assert_eq!(condition["drift"]["since"], Value::Null, "{condition}");
    }
}
