//! A refined sister is the best source there is: a refinement that names nothing takes its
//! champion.

use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::{Value, json};
use sistership_cli::sea_trials::TrialManoeuvre;
use sistership_model::Trial;
use sistership_tests::server::{TestServer, json as answer};

use super::over_http::{create, upload};
use super::sea_trials::{NAME, csv, sailed, ship};

const SISTER: &str = "younger-sister";

/// None of what the elder sister sailed.
fn trials() -> Vec<Trial> {
    let programme = [
        TrialManoeuvre::Zigzag(15.0, 15.0),
        TrialManoeuvre::Turn(16.0),
        TrialManoeuvre::Turn(-10.0),
    ];
    sailed(&programme, 11)
}

async fn create_sister(server: &TestServer) {
    let request = server
        .request(Method::POST, "/v1/ships")
        .header("content-type", "application/yaml")
        .body(ship().replace(&format!("name: {NAME}"), &format!("name: {SISTER}")));
    let (status, created) = answer(request.send().await.expect("an answer")).await;
    assert_eq!((status, created["name"].as_str()), (201, Some(SISTER)), "{created}");
    let entries: Vec<Value> =
        trials().iter().map(|t| json!({ "file": t.name, "manoeuvre": t.manoeuvre })).collect();
    let manifest = json!({ "kind": "trials", "ship": SISTER, "trials": entries }).to_string();
    let form = trials().iter().fold(Form::new().text("manifest", manifest), |form, trial| {
        form.part("file", Part::bytes(csv(trial)).file_name(trial.name.clone()))
    });
    let request = server.request(Method::POST, "/v1/trials").multipart(form);
    let (status, uploaded) = answer(request.send().await.expect("an answer")).await;
    assert_eq!(status, 201, "{uploaded}");
}

async fn refined(server: &TestServer, body: &Value, key: &str) -> Value {
    let (status, job) =
        server.send(Method::POST, "/v1/refinements", body, &[("Idempotency-Key", key)]).await;
    assert_eq!(status, 202, "{job}");
    let done = server.finished(job["id"].as_str().expect("an id")).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    done["result"].clone()
}

fn heading(result: &Value) -> f64 {
    result["held_out"]["refined"]["psi"].as_f64().expect("an error")
}

#[tokio::test(flavor = "multi_thread")]
async fn a_refined_sister_is_the_source_that_is_taken() {
    let server = TestServer::sqlite().await;
    assert_eq!(server.send(Method::DELETE, "/v1/ships/sr108", &Value::Null, &[]).await.0, 204);
    create(&server).await;
    upload(&server).await;
    refined(&server, &json!({ "ship": NAME }), "elder").await;
    create_sister(&server).await;
    // One zigzag to fit on; the turns are kept out to be judged on.
    let held_out: Vec<String> = trials()[1..].iter().map(|trial| trial.name.clone()).collect();
    let settings = json!({ "held_out": held_out });
    let plain = refined(&server, &json!({ "ship": SISTER, "settings": settings }), "plain").await;
    let source = plain["source"].as_str().unwrap_or_else(|| panic!("{}", plain["ladder"]));
    assert!(source.starts_with(&format!("{NAME}/")), "{}", plain["ladder"]);
    let settings = json!({ "held_out": held_out, "method": "weak" });
    let body = json!({ "ship": SISTER, "source": "mariner", "settings": settings });
    let zoo = refined(&server, &body, "zoo").await;
    let factor = heading(&zoo) / heading(&plain);
    println!("heading on trials kept out, the zoo's nearest by the sister: {factor:.1}");
    assert!(factor > 1.0, "{factor}");
    let path = format!("/v1/ships/{SISTER}/model");
    assert_eq!(server.get(&path).await["version"]["number"], 1);
}
