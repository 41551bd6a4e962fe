use std::time::Duration;

use sistership_store::{Begun, KEEP_KEYS, TAKE_OVER_AFTER, Ticket, sha256_hex};

use crate::support::*;

const SCOPE: &str = "POST /v1/refinements";

async fn begin(on: &TestStore, request: &str) -> Begun {
    on.store.idempotency().begin(SCOPE, "key-1", &sha256_hex(request.as_bytes())).await.unwrap()
}

async fn ticket(on: &TestStore) -> Ticket {
    match begin(on, "{}").await {
        Begun::New(ticket) => ticket,
        other => panic!("expected a new request, got {other:?}"),
    }
}

async fn an_answer_is_given_again(on: &TestStore) {
    let ticket = ticket(on).await;
    assert_eq!(begin(on, "{}").await, Begun::InProgress);
    on.store.idempotency().finish(&ticket, 202, r#"{"job":"1"}"#).await.unwrap();
    assert_eq!(begin(on, "{}").await, Begun::Replay { status: 202, body: r#"{"job":"1"}"#.into() });
    assert_eq!(begin(on, "{\"other\":1}").await, Begun::Mismatch);
    let elsewhere = on.store.idempotency().begin("POST /v1/ships", "key-1", &sha256_hex(b"")).await.unwrap();
    assert!(matches!(elsewhere, Begun::New(_)));
}

async fn an_abandoned_request_begins_anew(on: &TestStore) {
    let first = ticket(on).await;
    on.store.idempotency().abandon(&first).await.unwrap();
    ticket(on).await;
}

async fn a_dead_request_is_taken_over(on: &TestStore) {
    let dead = ticket(on).await;
    on.clock.advance(TAKE_OVER_AFTER - Duration::from_secs(1));
    assert_eq!(begin(on, "{}").await, Begun::InProgress);
    on.clock.advance(Duration::from_secs(1));
    let alive = ticket(on).await;
    assert_conflict(on.store.idempotency().finish(&dead, 500, "").await, "taken over");
    on.store.idempotency().abandon(&dead).await.unwrap();
    on.store.idempotency().finish(&alive, 201, "made").await.unwrap();
    assert_eq!(begin(on, "{}").await, Begun::Replay { status: 201, body: "made".into() });
}

async fn old_keys_are_forgotten(on: &TestStore) {
    on.store.idempotency().finish(&ticket(on).await, 201, "made").await.unwrap();
    on.clock.advance(KEEP_KEYS);
    assert_eq!(on.store.idempotency().purge().await.unwrap(), 0);
    on.clock.advance(Duration::from_secs(1));
    assert_eq!(on.store.idempotency().purge().await.unwrap(), 1);
    ticket(on).await;
}

on_both_databases!(
    an_answer_is_given_again,
    an_abandoned_request_begins_anew,
    a_dead_request_is_taken_over,
    old_keys_are_forgotten
);
