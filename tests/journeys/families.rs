//! A family of ships: what it teaches, the refinement of all of it by several workers, and a
//! person's word at the end.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use reqwest::Method;
use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;
use sistership_store::{JobState, ObjectStorage, PageRequest, Store, SystemClock};
use sistership_tests::binary;
use sistership_tests::fleet::{FOUNDATION, Yard, name};
use sistership_tests::server::TestServer;
use sistership_tests::worker::TestWorker;

const FAMILY: &str = "/v1/families/sisters";
const WORKERS: usize = 4;
const KILLED: usize = 3;
const LEASE_S: &str = "2";
const PATIENCE: Duration = Duration::from_secs(300);

/// A server without workers, with a family of `ships` that have sailed `trials` each, and the store
/// as an onlooker sees it.
async fn family(database: TestDatabase, ships: usize, trials: usize) -> (TestServer, Store) {
    let server = TestServer::on(database, &["--no-worker"]).await;
    let store =
        Store::connect(&server.database().url, Arc::new(SystemClock)).await.expect("a store");
    let objects =
        ObjectStorage::open_folder(server.store_arguments()[3].as_ref()).expect("the samples");
    Yard::new().launch(&store, &objects, 0..ships, trials).await;
    let members: Vec<String> = (0..ships).map(name).collect();
    let new = json!({ "name": "sisters", "foundation": FOUNDATION, "members": members });
    let (status, made) = server.send(Method::POST, "/v1/families", &new, &[]).await;
    assert_eq!((status, made["members"].as_u64()), (201, Some(ships as u64)), "{made}");
    (server, store)
}

fn hire(server: &TestServer) -> TestWorker {
    TestWorker::start(server, LEASE_S)
}

async fn learned(server: &TestServer) -> Value {
    let (status, job) =
        server.send(Method::POST, &format!("{FAMILY}/prior"), &json!({}), &[]).await;
    assert_eq!(status, 202, "{job}");
    let job = server.finished(job["id"].as_str().expect("an id")).await;
    assert_eq!(job["state"], "succeeded", "{job}");
    server.get(&format!("{FAMILY}/prior")).await
}

async fn asked(server: &TestServer, body: Value) -> String {
    let (status, bulk) = server
        .send(Method::POST, &format!("{FAMILY}/refinements"), &body, &[("idempotency-key", "once")])
        .await;
    assert_eq!(status, 202, "{bulk}");
    let (_, again) = server
        .send(Method::POST, &format!("{FAMILY}/refinements"), &body, &[("idempotency-key", "once")])
        .await;
    assert_eq!(bulk["id"], again["id"], "a repeated request is the same refinement");
    bulk["id"].as_str().expect("an id").to_owned()
}

async fn standing(server: &TestServer, id: &str) -> Value {
    server.get(&format!("/v1/bulk-refinements/{id}")).await
}

async fn until_done(server: &TestServer, id: &str) -> Value {
    let begun = Instant::now();
    loop {
        let standing = standing(server, id).await;
        if !matches!(standing["state"].as_str(), Some("queued" | "running")) {
            return standing;
        }
        assert!(begun.elapsed() < PATIENCE, "{standing}");
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
}

/// One outcome for each ship, one version for each that moved, and none besides.
async fn exactly_once(store: &Store, id: &str, ships: usize) {
    let outcomes = store
        .bulks()
        .list_outcomes(id, None, &PageRequest::first_page(1000))
        .await
        .expect("the outcomes")
        .items;
    let named: BTreeSet<&str> = outcomes.iter().map(|outcome| outcome.ship.as_str()).collect();
    assert_eq!((outcomes.len(), named.len()), (ships, ships));
    for outcome in &outcomes {
        let versions = store
            .versions()
            .list(&outcome.ship, &PageRequest::first_page(1000))
            .await
            .expect("the versions")
            .items;
        let numbers: Vec<i64> = versions.iter().map(|version| version.number).collect();
        assert_eq!((numbers, outcome.version), (vec![1], Some(1)), "{outcome:?}");
    }
}

fn fsck(server: &TestServer) {
    let store = server.store_arguments();
    let checked = binary::run(&["fsck", &store[0], &store[1], &store[2], &store[3]]);
    assert_eq!(checked.status.code(), Some(0), "{}", String::from_utf8_lossy(&checked.stdout));
}

fn verified(server: &TestServer, version: &str) {
    let store = server.store_arguments();
    let verified = binary::run(&["verify", version, &store[0], &store[1], &store[2], &store[3]]);
    assert_eq!(verified.status.code(), Some(0), "{}", String::from_utf8_lossy(&verified.stdout));
}

/// From ships that nobody has refined to champions: the small version of `cargo run --release
/// --example fleet`.
async fn a_family_is_learned_from_and_refined(database: TestDatabase) {
    const SHIPS: usize = 24;
    let (server, store) = family(database, SHIPS, 3).await;
    let early = server.send(Method::POST, &format!("{FAMILY}/refinements"), &json!({}), &[]).await;
    assert_eq!(early.0, 422, "{}", early.1);
    assert!(
        early.1["detail"].as_str().is_some_and(|detail| detail.contains("has no prior yet")),
        "{}",
        early.1
    );
    let _workers = [hire(&server), hire(&server)];
    let prior = learned(&server).await;
    let axis = prior["document"]["axes"]
        .as_array()
        .expect("axes")
        .iter()
        .find(|axis| axis["axis"] == "N")
        .expect("N")
        .clone();
    let place = axis["names"]
        .as_array()
        .expect("names")
        .iter()
        .position(|name| name == "N_r")
        .expect("N_r");
    let (mean, deviation) = (
        axis["mean"][place].as_f64().expect("a mean"),
        axis["deviation"][place].as_f64().expect("one"),
    );
    // Differences over a tenth of a length put the mean off by a fifth; by how much ships differ, a
    // twentieth, comes out.
    assert!(
        (mean / -166e-5 - 1.0).abs() < 0.3 && (0.02..0.1).contains(&(deviation / mean.abs())),
        "{mean} {deviation}"
    );

    let id = asked(&server, json!({ "rule": { "no_worse_than": 0.0 }, "chunk_ships": 5 })).await;
    let done = until_done(&server, &id).await;
    assert_eq!(
        (done["state"].as_str(), done["done"].as_u64()),
        (Some("succeeded"), Some(SHIPS as u64)),
        "{done}"
    );
    exactly_once(&store, &id, SHIPS).await;
    let champions = done["outcomes"]["champion"].as_u64().unwrap_or(0);
    assert!(champions > SHIPS as u64 / 2, "{done}");
    let candidates = done["outcomes"]["candidate"].as_u64().unwrap_or(0);
    let ships =
        server.get(&format!("/v1/bulk-refinements/{id}/ships?outcome=champion&limit=3")).await;
    for ship in ships["items"].as_array().expect("ships") {
        assert!(ship["worst_change"].as_f64().is_some_and(|change| change <= 0.0), "{ship}");
        assert!(ship["comparison"]["after"]["tactical_diameter_l"].is_number(), "{ship}");
    }
    let word = json!({ "actor": "ann", "reason": "looked at them all" });
    let (_, promoted) = server
        .send(Method::POST, &format!("/v1/bulk-refinements/{id}/champions"), &word, &[])
        .await;
    assert_eq!(promoted["champions"].as_u64(), Some(candidates), "{promoted}");
    assert!(
        server.get(&format!("/v1/ships/{}/model", name(3))).await["model"]["coefficients"]
            .is_object()
    );
    verified(&server, &format!("{}/1", name(0)));

    drift_is_seen(&server, &store).await;

    // New trials for none: the champions stand where they are, and the next refinement starts at
    // them.
    let (_, again) = server
        .send(
            Method::POST,
            &format!("{FAMILY}/refinements"),
            &json!({ "prior": "foundation" }),
            &[],
        )
        .await;
    let again = until_done(&server, again["id"].as_str().expect("an id")).await;
    assert_eq!(again["state"], "succeeded", "{again}");
    let second = store.versions().get(&name(0), 2).await.expect("a second version").head;
    let first = store.versions().get(&name(0), 1).await.expect("the first version").head;
    assert_eq!(second.parent, Some(first.id));
    verified(&server, &format!("{}/2", name(0)));
    fsck(&server);
}

/// A new trial of another ship's, under one's own name: its model no longer holds on it, and it is
/// listed first.
async fn drift_is_seen(server: &TestServer, store: &Store) {
    let strange = store
        .trials()
        .list(&name(7), &PageRequest::first_page(1))
        .await
        .expect("trials")
        .items
        .remove(0);
    let new = sistership_store::NewTrial {
        ship: name(5),
        sha256: strange.sha256,
        name: "a strange one".into(),
        manifest: strange.manifest,
        conventions: strange.conventions,
        manoeuvre: None,
        sample_rows: strange.sample_rows,
        duration_s: strange.duration_s,
        warnings: strange.warnings,
        object_key: strange.object_key,
    };
    store.trials().insert(&new).await.expect("a new trial");
    let drift = server.get(&format!("/v1/ships/{}/drift", name(5))).await;
    let trials = drift["trials"].as_array().expect("its trials");
    assert_eq!(trials.iter().filter(|trial| trial["fitted"] == false).count(), 1, "{drift}");
    assert!(drift["worst"].as_f64().is_some_and(|worst| worst > 1.2), "{drift}");
    let family = server.get(&format!("{FAMILY}/drift")).await;
    assert_eq!(
        family["ships"][0]["ship"].as_str(),
        Some(name(5).as_str()),
        "{}",
        family["ships"][0]
    );
    assert!(family["ships"][1]["drift"]["worst"].is_null(), "no other ship has anything new");
    let page = server
        .request(Method::GET, "/families/sisters")
        .send()
        .await
        .expect("a page")
        .text()
        .await
        .expect("its text");
    assert!(page.contains("Condition of the members") && page.contains(&name(5)), "{page}");
}

/// Four workers, three of which are killed in the middle of a chunk: no outcome can be written
/// until the last of them is dead, so that each is in one, on a fast machine as on a slow one.
async fn every_ship_is_refined_once(database: TestDatabase) {
    const SHIPS: usize = 120;
    let (server, store) = family(database, SHIPS, 2).await;
    let mut workers: Vec<TestWorker> = (0..WORKERS).map(|_| hire(&server)).collect();
    let held = server.database().hold_writes("bulk_outcomes").await;
    let id = asked(&server, json!({ "prior": "foundation", "chunk_ships": 3 })).await;
    for _ in 0..KILLED {
        let place = one_with_a_chunk(&store, &id, &workers).await;
        workers.swap_remove(place).kill();
        workers.push(hire(&server));
    }
    drop(held);
    let done = until_done(&server, &id).await;
    assert_eq!(
        (done["state"].as_str(), done["done"].as_u64()),
        (Some("succeeded"), Some(SHIPS as u64)),
        "{done}"
    );
    let lost = store
        .bulks()
        .chunk_jobs(&id, None)
        .await
        .expect("the chunks")
        .iter()
        .filter(|job| job.fence > 1)
        .count();
    assert!(lost >= KILLED, "{KILLED} workers were killed, but {lost} chunks have changed hands");
    exactly_once(&store, &id, SHIPS).await;
    fsck(&server);
}

/// Which of the workers holds a chunk that nobody held before.
async fn one_with_a_chunk(store: &Store, id: &str, workers: &[TestWorker]) -> usize {
    let begun = Instant::now();
    loop {
        let running =
            store.bulks().chunk_jobs(id, Some(JobState::Running)).await.expect("the chunks");
        let first = running.into_iter().filter(|job| job.attempt == 1);
        let holders: Vec<String> = first.filter_map(|job| job.worker).collect();
        let holds = |worker: &TestWorker| {
            let its_own = format!("{}-", worker.id());
            holders.iter().any(|name| name.starts_with(&its_own))
        };
        if let Some(place) = workers.iter().position(holds) {
            return place;
        }
        assert!(begun.elapsed() < PATIENCE, "no worker took a chunk");
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
}

/// What is cancelled stays undone until somebody goes on with it.
async fn a_refinement_is_cancelled_and_goes_on(database: TestDatabase) {
    const SHIPS: usize = 6;
    let (server, store) = family(database, SHIPS, 1).await;
    let id = asked(&server, json!({ "prior": "foundation", "chunk_ships": 2 })).await;
    let path = format!("/v1/bulk-refinements/{id}");
    let (_, cancelled) = server.send(Method::DELETE, &path, &json!({}), &[]).await;
    assert_eq!(
        (cancelled["state"].as_str(), cancelled["done"].as_u64()),
        (Some("cancelled"), Some(0)),
        "{cancelled}"
    );
    let (_, going) = server.send(Method::POST, &format!("{path}/retry"), &json!({}), &[]).await;
    assert_eq!(going["state"], "queued", "{going}");
    let _worker = hire(&server);
    assert_eq!(until_done(&server, &id).await["state"], "succeeded");
    exactly_once(&store, &id, SHIPS).await;
}

#[tokio::test]
async fn a_family_on_sqlite() {
    a_family_is_learned_from_and_refined(TestDatabase::new_sqlite()).await;
}

#[tokio::test]
async fn a_family_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        a_family_is_learned_from_and_refined(database).await;
    }
}

#[tokio::test]
async fn four_workers_refine_a_family_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        every_ship_is_refined_once(database).await;
    }
}

#[tokio::test]
async fn a_cancelled_refinement_goes_on() {
    a_refinement_is_cancelled_and_goes_on(TestDatabase::new_sqlite()).await;
}
