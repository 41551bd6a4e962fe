use std::time::Duration;

use sistership_store::{
    JobFilter, MAX_LIMIT, MAX_TEXT_BYTES, NewJob, NewReport, NewShip, NewTrial, NewVersion,
    PageRequest,
};

use crate::support::*;

async fn nul_is_refused_wherever_it_comes(on: &TestStore) {
    let store = &on.store;
    assert_invalid(store.laws().insert("a\0b", "").await, "name");
    assert_invalid(store.laws().insert("a", "a\0b").await, "document");
    assert_invalid(store.laws().get("a\0b").await, "name");
    assert_invalid(
        store.ships().create(&NewShip { title: "\0".into(), ..ship("kcs") }).await,
        "title",
    );
    assert_invalid(store.ships().list(Some("\0"), &PageRequest::first_page(1)).await, "category");
    assert_invalid(store.ships().list(None, &PageRequest::after_key("\0", 1)).await, "after");
    assert_invalid(store.versions().get("\0", 1).await, "model");
    assert_invalid(store.jobs().get("\0").await, "id");
    let filter = JobFilter { ship: Some("\0".into()), state: None };
    assert_invalid(store.jobs().list(&filter, &PageRequest::first_page(1)).await, "ship");
    assert_invalid(
        store.reports().insert(&NewReport { html: "\0".into(), ..report("kcs") }).await,
        "html",
    );
    assert_not_found(store.ships().get("kcs").await, "ship");
}

async fn what_is_no_number_is_refused(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    for duration_s in [f64::NAN, f64::INFINITY, -1.0] {
        let bad = NewTrial { duration_s, ..trial("kcs", "turn") };
        assert_invalid(on.store.trials().insert(&bad).await, "duration_s");
    }
    assert_invalid(
        on.store.trials().insert(&NewTrial { sample_rows: -1, ..trial("kcs", "turn") }).await,
        "sample_rows",
    );
    assert_invalid(
        on.store.jobs().heartbeat("x", 1, f64::NAN, "", Duration::ZERO).await,
        "progress",
    );
}

async fn what_is_no_json_or_hash_is_refused(on: &TestStore) {
    assert_invalid(
        on.store.ships().create(&NewShip { document: "{".into(), ..ship("kcs") }).await,
        "document",
    );
    assert_invalid(
        on.store
            .versions()
            .create(&NewVersion { document: "".into(), ..version("kcs") }, &[])
            .await,
        "document",
    );
    assert_invalid(
        on.store.jobs().enqueue(&NewJob { request: "NaN".into(), ..job("kcs") }).await,
        "request",
    );
    assert_invalid(
        on.store.trials().insert(&NewTrial { sha256: "ABC".into(), ..trial("kcs", "turn") }).await,
        "sha256",
    );
    assert_invalid(on.store.idempotency().begin_request("s", "k", "").await, "request_sha256");
}

async fn what_is_too_long_is_refused(on: &TestStore) {
    let longest = "x".repeat(MAX_TEXT_BYTES);
    on.store.laws().insert("long", &longest).await.unwrap();
    assert_eq!(on.store.laws().get("long").await.unwrap().document.len(), MAX_TEXT_BYTES);
    assert_invalid(on.store.laws().insert("longer", &(longest + "x")).await, "document");
    assert_invalid(on.store.laws().insert(&"x".repeat(201), "").await, "name");
    for name in ["", "a b", "a/b", "a\n"] {
        assert_invalid(on.store.laws().insert(name, "").await, "name");
    }
}

async fn a_page_has_a_size(on: &TestStore) {
    for limit in [0, -1, MAX_LIMIT + 1] {
        assert_invalid(on.store.laws().list(&PageRequest::first_page(limit)).await, "limit");
    }
    assert!(
        on.store.laws().list(&PageRequest::first_page(MAX_LIMIT)).await.unwrap().items.is_empty()
    );
}

on_both_databases!(
    nul_is_refused_wherever_it_comes,
    what_is_no_number_is_refused,
    what_is_no_json_or_hash_is_refused,
    what_is_too_long_is_refused,
    a_page_has_a_size
);
