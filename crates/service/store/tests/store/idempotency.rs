use std::time::Duration;

use sistership_store::{KEEP_KEYS, RequestClaim, RequestTicket, TAKE_OVER_AFTER, sha256_hex};

use crate::support::*;

const SCOPE: &str = "POST /v1/refinements";

async fn begin(on: &TestStore, request: &str) -> RequestClaim {
    on.store
        .idempotency()
        .begin_request(SCOPE, "key-1", &sha256_hex(request.as_bytes()))
        .await
        .unwrap()
}

async fn finish(
    on: &TestStore,
    ticket: &RequestTicket,
    status: i64,
    body: &str,
) -> sistership_store::Result<()> {
    on.store.begin_unit().commit(Some((ticket, status, body))).await
}

async fn ticket(on: &TestStore) -> RequestTicket {
    match begin(on, "{}").await {
        RequestClaim::New(ticket) => ticket,
        other => panic!("expected a new request, got {other:?}"),
    }
}

async fn an_answer_is_given_again(on: &TestStore) {
    let ticket = ticket(on).await;
    assert_eq!(begin(on, "{}").await, RequestClaim::InProgress);
    finish(on, &ticket, 202, r#"{"job":"1"}"#).await.unwrap();
    assert_eq!(
        begin(on, "{}").await,
        RequestClaim::Replay { status: 202, body: r#"{"job":"1"}"#.into() }
    );
    assert_eq!(begin(on, "{\"other\":1}").await, RequestClaim::Mismatch);
    let elsewhere = on
        .store
        .idempotency()
        .begin_request("POST /v1/ships", "key-1", &sha256_hex(b""))
        .await
        .unwrap();
    assert!(matches!(elsewhere, RequestClaim::New(_)));
}

async fn an_abandoned_request_begins_anew(on: &TestStore) {
    let first = ticket(on).await;
    on.store.idempotency().abandon_ticket(&first).await.unwrap();
    ticket(on).await;
}

async fn a_dead_request_is_taken_over(on: &TestStore) {
    let dead = ticket(on).await;
    on.clock.advance(TAKE_OVER_AFTER - Duration::from_secs(1));
    assert_eq!(begin(on, "{}").await, RequestClaim::InProgress);
    on.clock.advance(Duration::from_secs(1));
    let alive = ticket(on).await;
    assert_conflict(finish(on, &dead, 500, "").await, "handled by another connection");
    on.store.idempotency().abandon_ticket(&dead).await.unwrap();
    finish(on, &alive, 201, "made").await.unwrap();
    assert_eq!(begin(on, "{}").await, RequestClaim::Replay { status: 201, body: "made".into() });
}

async fn a_live_request_is_not_taken_over(on: &TestStore) {
    let alive = ticket(on).await;
    for _ in 0..3 {
        on.clock.advance(TAKE_OVER_AFTER - Duration::from_secs(1));
        assert_eq!(begin(on, "{}").await, RequestClaim::InProgress);
        on.store.idempotency().prolong_ticket(&alive).await.unwrap();
    }
    on.clock.advance(TAKE_OVER_AFTER);
    let next = ticket(on).await;
    assert_conflict(
        on.store.idempotency().prolong_ticket(&alive).await,
        "handled by another connection",
    );
    finish(on, &next, 201, "made").await.unwrap();
}

/// Work and answer are kept together, and what was taken over meanwhile leaves nothing.
async fn work_is_kept_with_its_answer(on: &TestStore) {
    let dead = ticket(on).await;
    on.clock.advance(TAKE_OVER_AFTER);
    let alive = ticket(on).await;
    let late = on.store.begin_unit();
    late.store().ships().create(&ship("kcs")).await.unwrap();
    assert_eq!(late.store().ships().get("kcs").await.unwrap().revision, 1);
    assert_conflict(late.commit(Some((&dead, 201, "late"))).await, "handled by another connection");
    assert_not_found(on.store.ships().get("kcs").await, "ship");
    let work = on.store.begin_unit();
    work.store().ships().create(&ship("kcs")).await.unwrap();
    // A step that fails takes nothing from the others.
    assert_conflict(work.store().ships().create(&ship("kcs")).await, "exists already");
    assert_not_found(
        work.store()
            .aliases()
            .move_to("kcs", 1, &champion(sistership_store::ExpectedRevision::Any))
            .await,
        "model",
    );
    work.store().versions().create(&version("kcs"), &[]).await.unwrap();
    work.commit(Some((&alive, 201, "made"))).await.unwrap();
    assert_eq!(on.store.ships().get("kcs").await.unwrap().revision, 1);
    assert_eq!(on.store.versions().latest("kcs").await.unwrap().head.number, 1);
    assert_eq!(begin(on, "{}").await, RequestClaim::Replay { status: 201, body: "made".into() });
}

async fn work_that_is_not_kept_leaves_nothing(on: &TestStore) {
    for undo in [true, false] {
        let work = on.store.begin_unit();
        work.store().versions().create(&version("kcs"), &[]).await.unwrap();
        if undo {
            work.rollback().await
        } else {
            drop(work)
        }
        assert_not_found(on.store.versions().latest("kcs").await, "model");
    }
    versions(on, "kcs", 1).await;
}

async fn old_keys_are_forgotten(on: &TestStore) {
    finish(on, &ticket(on).await, 201, "made").await.unwrap();
    on.clock.advance(KEEP_KEYS);
    assert_eq!(on.store.idempotency().purge_expired().await.unwrap(), 0);
    on.clock.advance(Duration::from_secs(1));
    assert_eq!(on.store.idempotency().purge_expired().await.unwrap(), 1);
    ticket(on).await;
}

on_both_databases!(
    an_answer_is_given_again,
    an_abandoned_request_begins_anew,
    a_dead_request_is_taken_over,
    a_live_request_is_not_taken_over,
    work_is_kept_with_its_answer,
    work_that_is_not_kept_leaves_nothing,
    old_keys_are_forgotten
);
