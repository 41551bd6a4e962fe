//! What people state about ships, trials and versions by REST, as pages show it.

use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;

use super::access::OWNER;
use super::harness::{Harness, read};

/// A zigzag by latitude and longitude, whose first fix is in the Skagerrak.
const PLACED_CSV: &str = "t_s,u_m_s,v_m_s,r_rad_s,psi_rad,delta_rad,latitude_deg,longitude_deg\n\
    0,8,0,0,0,0,57.9,9.8\n1,8,0,0,0,0,57.90007,9.8\n2,8,0,0,0,0,57.90014,9.8\n\
    3,8,0,0,0,0,57.90021,9.8\n";

impl Harness {
    async fn put(&self, path: &str, body: &Value) -> (StatusCode, Value) {
        let request = self.client.put(self.url(path)).header("if-match", "*").json(body);
        read(request.send().await.unwrap()).await
    }

    async fn page(&self, path: &str) -> String {
        self.client.get(self.url(path)).send().await.unwrap().text().await.unwrap()
    }

    async fn upload_placed(&self) -> String {
        let path = "/v1/trials?ship=mariner&name=a.csv&n_rps=1.5&current_north_m_s=0.5";
        let post = self.client.post(self.url(path)).header("content-type", "text/csv");
        let (status, uploaded) = read(post.body(PLACED_CSV).send().await.unwrap()).await;
        assert_eq!(status, StatusCode::CREATED, "{uploaded}");
        let manifest = &uploaded["trials"][0]["manifest"];
        // Revolutions, current and position are kept with the trial.
        assert_eq!(manifest["trials"][0]["n_rps"], 1.5, "{manifest}");
        assert_eq!(manifest["currents"][0]["north_m_s"], 0.5, "{manifest}");
        assert_eq!(manifest["origin"], json!({ "latitude_deg": 57.9, "longitude_deg": 9.8 }));
        uploaded["trials"][0]["id"].as_str().unwrap().to_owned()
    }
}

async fn statements_by_rest_are_those_of_the_pages(database: TestDatabase) {
    let harness = Harness::on(database).await;
    let path = format!("/v1/trials/{}/conditions", harness.upload_placed().await);
    assert_eq!(harness.get(&path).await["conditions"], json!({}));
    let stated = json!({ "date": "2026-11-29", "place": "Skagerrak", "draught_aft_m": 8.5 });
    let (status, kept) = harness.put(&path, &stated).await;
    assert_eq!(status, StatusCode::OK, "{kept}");
    let form = harness.page("/ships/mariner/conditions").await;
    for text in ["2026-11-29", "Skagerrak", "value=\"8.5\""] {
        assert!(form.contains(text), "the form has {text}");
    }
    let (status, problem) = harness.put(&path, &json!({ "date": "29.11.2026" })).await;
    assert_eq!((status.as_u16(), &problem["errors"][0]["field"]), (422, &json!("date")));
    assert_eq!(harness.get(&path).await, kept, "a refused statement changes nothing");

    let path = "/v1/models/mariner/versions/1/signatures";
    let (status, signed) =
        harness.post(path, &json!({ "role": "checked", "person": "Ann Surveyor" })).await;
    assert_eq!(status, StatusCode::CREATED, "{signed}");
    assert_eq!(signed["person"], "Ann Surveyor");
    let listed = harness.get(path).await;
    assert_eq!(listed["signatures"][0]["person"], "Ann Surveyor", "{listed}");
    let summary = harness.page("/ships/mariner/versions/1/acceptance").await;
    assert!(summary.contains("Ann Surveyor"));

    let change =
        json!({ "citation": "draught survey", "values": { "draught_aft_m": 8.25, "gm_m": null } });
    let (status, ship) = harness.put("/v1/ships/mariner/particulars", &change).await;
    assert_eq!(status, StatusCode::OK, "{ship}");
    let values = &ship["document"]["particulars"]["values"];
    assert_eq!(values["draught_aft_m"]["value"], 8.25, "{values}");
    assert!(values.get("gm_m").is_none(), "{values}");
    assert!(harness.page("/ships/mariner/particulars").await.contains("value=\"8.25\""));
    let unknown = json!({ "citation": "x", "values": { "masts": 3.0 } });
    let (status, problem) = harness.put("/v1/ships/mariner/particulars", &unknown).await;
    assert!(status == 422 && problem.to_string().contains("masts"), "{problem}");

    let settings = json!({ "second_person": false, "public_url": "https://ships.example" });
    assert_eq!(harness.put("/v1/settings", &settings).await, (StatusCode::OK, settings));
    assert!(harness.page("/webhooks").await.contains("https://ships.example"));
    harness.server.stop().await;
}

on_both_databases!(
    statements_by_rest_are_those_of_the_pages,
    authors_do_not_approve,
    ships_are_on_the_map,
);

async fn ships_are_on_the_map(database: TestDatabase) {
    let harness = Harness::on(database).await;
    let trial = harness.upload_placed().await;
    // Positions are facts of the search index, which follows within seconds.
    let mut fleet = String::new();
    for _ in 0..200 {
        fleet = harness.page("/").await;
        if fleet.contains("Where the ships are") {
            break;
        }
        tokio::time::sleep(std::time::Duration::from_millis(50)).await;
    }
    assert!(fleet.contains("<a href=\"/ships/mariner\" tabindex=\"-1\">"), "no mark on the map");
    assert!(fleet.contains("57.9° N, 9.8° E"), "no row in the table");
    // A version in a list has its turning circle.
    let ship = harness.page("/ships/mariner").await;
    assert!(ship.contains("src=\"/ships/mariner/versions/1/turn.svg\""));
    for path in ["/ships/mariner/versions/1/turn.svg", "/ships/mariner/turn.svg"] {
        let picture = harness.client.get(harness.url(path)).send().await.unwrap();
        assert_eq!(picture.headers()["content-type"], "image/svg+xml");
        assert!(picture.text().await.unwrap().contains("d=\"M"), "{path}");
    }
    let delete = harness.client.delete(harness.url(&format!("/v1/trials/{trial}")));
    assert_eq!(delete.send().await.unwrap().status().as_u16(), 204);
    harness.server.stop().await;
}

async fn authors_do_not_approve(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let settings = json!({ "second_person": true });
    assert_eq!(harness.sends(OWNER, Method::PUT, "/v1/settings", &settings).await.0, 200);
    let roles = json!([{ "role": "engineer", "ship": "mariner" }]);
    let engineer = harness.key(&json!({ "title": "engineer", "roles": roles })).await;
    let approver = json!([{ "role": "approver", "ship": "mariner" }]);
    let approver = harness.key(&json!({ "title": "approver", "roles": approver })).await;
    let path = "/v1/models/mariner/versions/1/signatures";
    let sign = |role: &str| json!({ "role": role, "person": "Ann" });
    for (key, role, allowed) in
        [(&engineer, "checked", 201), (&engineer, "approved", 403), (&approver, "approved", 201)]
    {
        let (status, answer) = harness.sends(key, Method::POST, path, &sign(role)).await;
        assert_eq!(status.as_u16(), allowed, "{role}: {answer}");
    }
    harness.server.stop().await;
}
