//! Finding ships over HTTP.

use std::time::{Duration, Instant};

use serde_json::Value;
use sistership_store::testing::TestDatabase;

use super::harness::Harness;

fn names(listing: &Value) -> Vec<&str> {
    listing["items"].as_array().unwrap().iter().map(|ship| ship["name"].as_str().unwrap()).collect()
}

fn values(listing: &Value) -> Vec<f64> {
    listing["items"]
        .as_array()
        .unwrap()
        .iter()
        .map(|ship| ship["value"].as_f64().unwrap())
        .collect()
}

/// Returns the items of a list once it has at least `count`: the search index follows changes in
/// the background.
async fn once_there_are(harness: &Harness, count: usize, path: &str) -> Value {
    let start = Instant::now();
    loop {
        let listing = harness.get(path).await;
        if names(&listing).len() >= count {
            return listing;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "{path} has only {listing}");
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
}

async fn find(database: TestDatabase) {
    let harness = Harness::on(database).await;
    let all = harness.get("/v1/ships").await;
    let long =
        once_there_are(&harness, 5, "/v1/ships?particular=lpp_m:100..&particular=beam_m:..60")
            .await;
    assert!(
        values(&long).is_sorted()
            && values(&long)[0] >= 100.0
            && names(&long).len() < names(&all).len()
    );
    let turning =
        once_there_are(&harness, 5, "/v1/ships?metric=turn_35.tactical_diameter_m:..").await;
    assert!(values(&turning).is_sorted());
    let half = values(&turning)[2];
    let tight =
        harness.get(&format!("/v1/ships?metric=turn_35.tactical_diameter_m:..{half}")).await;
    assert_eq!(names(&tight), names(&turning)[..3]);
    page_by_page(&harness, "/v1/ships?metric=turn_35.tactical_diameter_m:..", &turning).await;
    page_by_page(&harness, "/v1/ships?", &all).await;
    tags(&harness).await;
    similar(&harness).await;
    harness.create_ship().await;
    let new =
        once_there_are(&harness, 2, "/v1/ships?particular=rudder_area_m2:33.0375..33.0377").await;
    assert_eq!(names(&new), ["demo-ship", "sr108"]);
    harness.server.stop().await;
}

async fn page_by_page(harness: &Harness, path: &str, whole: &Value) {
    let (mut pieces, mut after) = (Vec::new(), String::new());
    loop {
        let piece = harness.get(&format!("{path}&limit=2{after}")).await;
        pieces.extend(names(&piece).into_iter().map(str::to_owned));
        let Some(next) = piece["next"].as_str() else { break };
        after = format!("&after={next}");
    }
    assert_eq!(pieces, names(whole));
}

async fn tags(harness: &Harness) {
    for ship in ["kcs", "mariner"] {
        let put = harness
            .client
            .put(harness.url(&format!("/v1/ships/{ship}/tags/own")))
            .send()
            .await
            .unwrap();
        assert_eq!(put.status(), 204);
    }
    assert_eq!(names(&harness.get("/v1/ships?tag=own").await), ["kcs", "mariner"]);
    assert_eq!(harness.get("/v1/ships/kcs/tags").await, serde_json::json!(["own"]));
    let delete = harness.client.delete(harness.url("/v1/ships/kcs/tags/own")).send().await.unwrap();
    assert_eq!(delete.status(), 204);
    assert_eq!(names(&harness.get("/v1/ships?tag=own").await), ["mariner"]);
}

/// The order of the ranking, of which a search has the ships of the same category.
async fn similar(harness: &Harness) {
    let category = harness.get("/v1/ships/kvlcc2").await["category"].as_str().unwrap().to_owned();
    let same = harness.get(&format!("/v1/ships?category={category}")).await;
    let ranking = harness.get("/v1/ships/kvlcc2/similar?trials=false").await;
    let ranked = ranking["ranking"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|ranked| ranked["correlation"].is_number());
    let ranked = ranked
        .map(|ranked| ranked["ship"].as_str().unwrap())
        .filter(|ship| names(&same).contains(ship));
    let found = harness.get("/v1/ships?similar_to=kvlcc2").await;
    assert!(!names(&found).is_empty() && values(&found).is_sorted_by(|a, b| a >= b));
    assert_eq!(names(&found), ranked.collect::<Vec<_>>());
    page_by_page(harness, "/v1/ships?similar_to=kvlcc2", &found).await;
    let close = format!(
        "/v1/ships?similar_to=kvlcc2&vector=kanazawa-2023&category={category}&particular=lpp_m:300.."
    );
    assert!(names(&harness.get(&close).await).iter().all(|ship| names(&found).contains(ship)));
}

#[tokio::test(flavor = "multi_thread")]
async fn ships_are_found_on_sqlite() {
    find(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn ships_are_found_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        find(database).await;
    }
}
