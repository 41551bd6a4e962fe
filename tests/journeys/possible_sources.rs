//! Which ships may be a source has one answer: on the page of a ship, over HTTP, on the command
//! line, and in the selection of a source.

use std::collections::BTreeMap;

use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::{Value, json};
use sistership_tests::binary;
use sistership_tests::server::{TestServer, json as answer};

use super::sea_trials::{NAME, csv, few, ship};

/// More than a dozen: none is overlooked.
const SISTERS: usize = 15;
/// The sister that has no champion.
const WITHOUT: &str = "sister-13";
/// The sister whose champion carries an effect of its own.
const WITH_EFFECT: &str = "sister-14";

/// What is said of each ship: model, law, whether it may be the source, and why.
type Answers = BTreeMap<String, [Value; 4]>;

fn answers(ranking: &Value) -> Answers {
    let ranked = ranking.as_array().unwrap_or_else(|| panic!("no ranking: {ranking}"));
    let said = |ranked: &Value| ["model", "law", "eligible", "reasons"].map(|k| ranked[k].clone());
    ranked.iter().map(|one| (one["ship"].as_str().expect("a ship").to_owned(), said(one))).collect()
}

async fn create_ship(server: &TestServer, name: &str) {
    let document = ship().replace(&format!("name: {NAME}"), &format!("name: {name}"));
    let request = server.request(Method::POST, "/v1/ships");
    let request = request.header("content-type", "application/yaml").body(document);
    let (status, created) = answer(request.send().await.expect("an answer")).await;
    assert_eq!(status, 201, "{created}");
}

async fn register_champion(server: &TestServer, ship: &str, model: &Value) {
    let mut model = model.clone();
    (model["ship"], model["name"]) = (json!(ship), json!(format!("{ship}/refined")));
    let body = json!({ "model": model, "origin": "a towing tank" });
    let path = format!("/v1/models/{ship}/versions");
    let (status, made) = server.send(Method::POST, &path, &body, &[]).await;
    assert_eq!(status, 201, "{made}");
    let path = format!("/v1/models/{ship}/aliases/champion");
    let body = json!({ "version": 1, "reason": "the first" });
    let (status, moved) = server.send(Method::PUT, &path, &body, &[("if-none-match", "*")]).await;
    assert!(status < 300, "{moved}");
}

/// Sisters of one hull with champions, and a ship that has none.
async fn fleet(server: &TestServer) {
    let model = server.get("/v1/ships/sr108/model").await["model"].clone();
    create_ship(server, NAME).await;
    for number in 0..SISTERS {
        let sister = format!("sister-{number:02}");
        create_ship(server, &sister).await;
        let mut model = model.clone();
        if sister == WITH_EFFECT {
            model["effects"] = json!([rudder_offset()]);
        }
        if sister != WITHOUT {
            register_champion(server, &sister, &model).await;
        }
    }
}

fn rudder_offset() -> Value {
    let zoo = sistership_model::Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let effect = zoo.effect("rudder-offset").expect("in the library");
    let form = serde_json::to_value(&effect.forms[0].file).expect("JSON");
    json!({ "name": "rudder-offset", "acts_on": effect.acts_on, "form": form,
        "parameters": { "offset_rad": { "value": 0.05, "source": "a diagnosis" } } })
}

async fn upload(server: &TestServer) {
    let trials = few();
    let entries: Vec<Value> =
        trials.iter().map(|t| json!({ "file": t.name, "manoeuvre": t.manoeuvre })).collect();
    let manifest = json!({ "kind": "trials", "ship": NAME, "trials": entries }).to_string();
    let form = trials.iter().fold(Form::new().text("manifest", manifest), |form, trial| {
        form.part("file", Part::bytes(csv(trial)).file_name(trial.name.clone()))
    });
    let request = server.request(Method::POST, "/v1/trials").multipart(form);
    let (status, uploaded) = answer(request.send().await.expect("an answer")).await;
    assert_eq!(status, 201, "{uploaded}");
}

async fn over_http(server: &TestServer, trials: bool) -> Answers {
    let path = format!("/v1/ships/{NAME}/similar?trials={trials}");
    answers(&server.get(&path).await["ranking"])
}

async fn on_the_command_line(server: &TestServer) -> Answers {
    let store = server.store_arguments();
    let run = move || {
        let mut arguments = vec!["similar", NAME, "--json"];
        arguments.extend(store.iter().map(String::as_str));
        binary::json(&arguments, 0)
    };
    answers(&tokio::task::spawn_blocking(run).await.expect("it ends")["ranking"])
}

/// The rows of the page: what each says is what the other places say.
async fn same_on_the_page(server: &TestServer, said: &Answers) {
    let request = server.request(Method::GET, &format!("/ships/{NAME}"));
    let page = request.send().await.expect("an answer").text().await.expect("a page");
    let table = page.split("<h2>Similar ships</h2>").nth(1).expect("similar ships");
    let rows: Vec<&str> = table.split("<tr>").skip(2).collect();
    assert_eq!(rows.len(), 5, "{table}");
    for row in rows {
        let ship = row.split("/ships/").nth(1).and_then(|rest| rest.split('"').next());
        let ship = ship.unwrap_or_else(|| panic!("{row}"));
        let [_, law, eligible, reasons] = &said[ship];
        assert!(row.contains(law.as_str().unwrap_or_default()), "{row}");
        assert_eq!(row.contains(">yes</span>"), eligible == &json!(true), "{row}");
        for reason in reasons.as_array().expect("reasons") {
            assert!(row.contains(reason.as_str().expect("text")), "{reason} in {row}");
        }
    }
}

async fn selected(server: &TestServer, settings: &Value) -> Value {
    let body = json!({ "ship": NAME, "settings": settings });
    let (status, job) = server.send(Method::POST, "/v1/refinements", &body, &[]).await;
    assert_eq!(status, 202, "{job}");
    let done = server.finished(job["id"].as_str().expect("an id")).await;
    assert_eq!(done["state"], "succeeded", "{done}");
    done["result"].clone()
}

async fn journey(server: TestServer) {
    fleet(&server).await;
    let said = over_http(&server, false).await;
    for number in 0..SISTERS {
        let sister = format!("sister-{number:02}");
        let [model, law, eligible, reasons] = &said[&sister];
        let reason = reasons.as_array().and_then(|all| all.last()).expect("a reason").to_string();
        match sister.as_str() {
            WITHOUT => assert!(reason.contains("no model, only particulars"), "{reason}"),
            WITH_EFFECT => assert!(reason.contains("has the effect rudder-offset"), "{reason}"),
            _ => {
                let expected = json!([format!("{sister}/refined"), "son-nomoto", true]);
                assert_eq!(json!([model, law, eligible]), expected, "{sister}: {reasons}");
            }
        }
    }
    assert_eq!(on_the_command_line(&server).await, said, "on the command line");
    same_on_the_page(&server, &said).await;
    upload(&server).await;
    let measured = over_http(&server, true).await;
    for settings in [json!({ "method": "weak" }), json!({})] {
        let result = selected(&server, &settings).await;
        assert_eq!(answers(&result["ranking"]), measured, "selection with {settings}");
        if settings == json!({ "method": "weak" }) {
            assert_eq!(result["source"], "sister-00/1", "{result}");
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn one_answer_to_which_ships_may_be_a_source() {
    journey(TestServer::sqlite().await).await;
}
