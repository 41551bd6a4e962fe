//! Webhooks: what they are told is written with what it tells of, and taken by one at a time.

use sistership_store::{DIAGNOSIS_FAILED, DRIFT, ExpectedRevision, NewWebhook, PageRequest};

use crate::support::*;

fn webhook(events: &[&str], ship: Option<&str>) -> NewWebhook {
    NewWebhook {
        title: "Bridge".into(),
        url: "https://example.com/".into(),
        secret: "secret".into(),
        ship: ship.map(str::to_owned),
        drift_above: 2.0,
        events: events.iter().map(|event| (*event).to_owned()).collect(),
    }
}

/// Events of a webhook's deliveries, the first first.
async fn told(on: &TestStore, id: &str) -> Vec<String> {
    let told =
        on.store.webhooks().list_deliveries(id, &PageRequest::first_page(100)).await.unwrap();
    told.items.into_iter().rev().map(|delivery| delivery.event).collect()
}

async fn a_move_is_told_with_its_transaction(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    on.store.ships().create(&ship("kvlcc2")).await.unwrap();
    let webhooks = on.store.webhooks();
    let all = webhooks.create(&webhook(&["champion.moved"], None)).await.unwrap();
    let own = webhooks.create(&webhook(&["champion.moved"], Some("kvlcc2"))).await.unwrap();
    let deaf = webhooks.create(&webhook(&[DRIFT], None)).await.unwrap();
    on.store
        .versions()
        .create(&version("kcs"), &[champion(ExpectedRevision::Absent)])
        .await
        .unwrap();
    assert_eq!(told(on, &all.id).await, ["champion.moved"]);
    assert!(told(on, &own.id).await.is_empty() && told(on, &deaf.id).await.is_empty());
    // A move that is refused is told to nobody.
    let refused =
        on.store.aliases().move_to("kcs", 1, &champion(ExpectedRevision::Revision(7))).await;
    assert!(refused.is_err());
    assert_eq!(told(on, &all.id).await.len(), 1);
}

async fn a_delivery_is_taken_by_one_until_its_time_is_over(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let webhooks = on.store.webhooks();
    let id = webhooks.create(&webhook(&["champion.moved"], None)).await.unwrap().id;
    on.store
        .versions()
        .create(&version("kcs"), &[champion(ExpectedRevision::Absent)])
        .await
        .unwrap();
    assert_eq!(webhooks.due_receivers().await.unwrap(), std::slice::from_ref(&id));
    let until = on.store.now_us() + 60_000_000;
    let (taken, of) = webhooks.take_due(&id, until).await.unwrap().unwrap();
    assert_eq!((taken.attempts, of.secret.as_str()), (1, "secret"));
    assert_eq!(webhooks.take_due(&id, until).await.unwrap(), None, "another has it");
    webhooks.record_failure(&taken.id, Some(on.store.now_us()), "answered 500").await.unwrap();
    let (again, _) = webhooks.take_due(&id, until).await.unwrap().unwrap();
    assert_eq!((again.id.as_str(), again.attempts), (taken.id.as_str(), 2));
    webhooks.record_arrival(&again.id, "204").await.unwrap();
    // What comes too late of an earlier attempt does not send it again.
    webhooks.record_failure(&again.id, Some(on.store.now_us()), "no answer in time").await.unwrap();
    assert_eq!(webhooks.take_due(&id, until).await.unwrap(), None);
    assert_not_found(webhooks.retry_delivery(&of.id, &again.id).await, "delivery under way");
}

async fn what_has_ended_is_told_nothing(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let webhooks = on.store.webhooks();
    let made =
        webhooks.create(&webhook(&["champion.moved", DIAGNOSIS_FAILED], None)).await.unwrap();
    on.store
        .versions()
        .create(&version("kcs"), &[champion(ExpectedRevision::Absent)])
        .await
        .unwrap();
    webhooks.end_webhook(&made.id).await.unwrap();
    assert_conflict(webhooks.end_webhook(&made.id).await, "ended");
    assert_eq!(webhooks.take_due(&made.id, i64::MAX).await.unwrap(), None);
    let moved = on.store.aliases().move_to("kcs", 1, &champion(ExpectedRevision::Any)).await;
    moved.unwrap();
    assert_eq!(told(on, &made.id).await.len(), 1);
    assert_eq!(webhooks.list_events(&made.id).await.unwrap(), ["champion.moved", DIAGNOSIS_FAILED]);
    assert_invalid(webhooks.create(&webhook(&[], None)).await, "events");
    assert_invalid(webhooks.create(&webhook(&["sunrise"], None)).await, "events");
    assert_invalid(webhooks.create(&webhook(&[DRIFT, DRIFT], None)).await, "events");
    assert_invalid(webhooks.create(&webhook(&[DRIFT], Some("nobody"))).await, "ship");
    assert_not_found(webhooks.get("nowhere").await, "webhook");
}

on_both_databases!(
    a_move_is_told_with_its_transaction,
    a_delivery_is_taken_by_one_until_its_time_is_over,
    what_has_ended_is_told_nothing,
);
