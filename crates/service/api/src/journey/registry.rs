//! Many requests at once: versions of one model without gaps, and one winner for each state of an
//! alias.
//!
//! `SISTERSHIP_FULL=1` has 2000 of the first and 500 of the second.

use futures::future::join_all;
use reqwest::StatusCode;
use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, read};

/// Number of requests at once.
fn crowd(few: usize, full: usize) -> usize {
    if std::env::var("SISTERSHIP_FULL").is_ok_and(|value| value == "1") { full } else { few }
}

async fn body(harness: &Harness) -> Value {
    let champion = harness.get("/v1/ships/mariner/model").await;
    json!({ "model": champion["model"], "origin": "a test", "parent": 1 })
}

async fn versions_have_no_gap(harness: &Harness) {
    let (count, body) = (crowd(100, 2000), body(harness).await);
    let made =
        join_all((0..count).map(|_| harness.post("/v1/models/mariner/versions", &body))).await;
    let number = |(status, version): &(StatusCode, Value)| {
        assert_eq!(
            (*status, version["method"].as_str()),
            (StatusCode::CREATED, Some("registered")),
            "{version}"
        );
        version["number"].as_u64().unwrap()
    };
    let mut numbers: Vec<u64> = made.iter().map(number).collect();
    numbers.sort_unstable();
    assert!(numbers.iter().copied().eq(2..count as u64 + 2), "{numbers:?}");
    let parent = &harness.get("/v1/models/mariner/versions/1").await["version"]["id"];
    assert!(made.iter().all(|(_, version)| version["parent"] == *parent));
    let latest = harness.get("/v1/models/mariner/aliases/latest").await;
    assert_eq!(latest["version"], count + 1);
    let verified = harness.post("/v1/models/mariner/versions/2/verify", &Value::Null).await.1;
    assert_eq!(
        (&verified["identical"], &verified["remarks"]),
        (&json!(true), &json!([])),
        "{verified}"
    );
}

async fn each_state_of_an_alias_has_one_successor(harness: &Harness) {
    let (count, place) = (crowd(50, 500), harness.url("/v1/models/mariner/aliases/champion"));
    for round in 1..=3 {
        let tag = harness.client.get(&place).send().await.unwrap().headers()["etag"]
            .to_str()
            .unwrap()
            .to_owned();
        let change = json!({ "version": 2, "reason": "a test" });
        let moves = (0..count)
            .map(|_| harness.client.put(&place).header("if-match", &tag).json(&change).send());
        let statuses: Vec<u16> = join_all(moves)
            .await
            .into_iter()
            .map(|answer| answer.unwrap().status().as_u16())
            .collect();
        let of = |status: u16| statuses.iter().filter(|found| **found == status).count();
        assert_eq!((of(200), of(412)), (1, count - 1), "in round {round}: {statuses:?}");
    }
    let history = harness.get("/v1/models/mariner/aliases/champion/history").await;
    assert_eq!(history["items"].as_array().unwrap().len(), 4);
}

async fn what_is_wrong_is_named(harness: &Harness) {
    let good = body(harness).await;
    let wrong = |change: fn(&mut Value)| {
        let mut body = good.clone();
        change(&mut body);
        async move { harness.post("/v1/models/mariner/versions", &body).await }
    };
    for ((status, problem), field) in [
        (wrong(|body| body["model"]["ship"] = json!("kcs")).await, "model.ship"),
        (wrong(|body| body["model"]["law"] = json!("unheard-of")).await, "model.law"),
        (
            wrong(|body| {
                body["model"]["coefficients"]["X_x"] = json!({ "value": 1.0, "source": "a test" })
            })
            .await,
            "model.",
        ),
        (wrong(|body| body["model"]["status"] = json!("excellent")).await, "model.status"),
        (wrong(|body| body["origin"] = json!(" ")).await, "origin"),
        (wrong(|body| body["parent"] = json!(99_999)).await, "parent"),
    ] {
        let found = problem["errors"][0]["field"].as_str().unwrap_or_default();
        assert!(status == 422 && found.starts_with(field), "{field}: {problem}");
    }
    let (status, _) = harness
        .post("/v1/models/atlantis/versions", &json!({ "model": {}, "origin": "a test" }))
        .await;
    assert_eq!(status, 422);
    let keyed = || {
        harness
            .client
            .post(harness.url("/v1/models/mariner/versions"))
            .header("idempotency-key", "once")
            .json(&good)
    };
    let (first, again) =
        (read(keyed().send().await.unwrap()).await, read(keyed().send().await.unwrap()).await);
    assert_eq!(first, again);
}

async fn crowded(database: TestDatabase) {
    let harness = Harness::on(database).await;
    versions_have_no_gap(&harness).await;
    each_state_of_an_alias_has_one_successor(&harness).await;
    what_is_wrong_is_named(&harness).await;
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn many_at_once_on_sqlite() {
    crowded(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn many_at_once_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        crowded(database).await;
    }
}
