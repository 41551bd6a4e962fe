use std::time::Duration;

use sistership_store::{NewShip, PageRequest};

use crate::support::*;

async fn a_ship_keeps_its_history(on: &TestStore) {
    let ships = on.store.ships();
    let made = ships.create(&ship("kvlcc2")).await.unwrap();
    assert_eq!(made.revision, 1);
    on.clock.advance(Duration::from_secs(1));
    let changed = NewShip { document: r#"{"lpp_m":7.0}"#.into(), ..ship("kvlcc2") };
    let updated = ships.update(&changed, 1).await.unwrap();
    assert_eq!((updated.revision, updated.updated_us - updated.created_us), (2, 1_000_000));
    let history = ships.list_revisions("kvlcc2", &PageRequest::first_page(10)).await.unwrap().items;
    let documents: Vec<_> =
        history.iter().map(|revision| (revision.revision, revision.document.as_str())).collect();
    assert_eq!(documents, [(2, changed.document.as_str()), (1, ship("kvlcc2").document.as_str())]);
}

async fn only_the_revision_seen_can_be_replaced(on: &TestStore) {
    let ships = on.store.ships();
    ships.create(&ship("kcs")).await.unwrap();
    ships.update(&ship("kcs"), 1).await.unwrap();
    assert_stale(ships.update(&ship("kcs"), 1).await, Some(2));
    assert_stale(ships.delete("kcs", Some(1)).await, Some(2));
    assert_not_found(ships.update(&ship("pcc"), 1).await, "ship");
    assert_eq!(
        ships.list_revisions("kcs", &PageRequest::first_page(10)).await.unwrap().items.len(),
        2
    );
}

async fn a_deletion_can_be_undone(on: &TestStore) {
    let ships = on.store.ships();
    let made = ships.create(&ship("sr108")).await.unwrap();
    assert!(ships.delete("sr108", Some(1)).await.unwrap().deleted_us.is_some());
    assert_not_found(ships.get("sr108").await, "ship");
    assert_not_found(ships.delete("sr108", None).await, "ship");
    assert_not_found(ships.update(&ship("sr108"), 1).await, "ship");
    assert!(ships.list(None, &PageRequest::first_page(10)).await.unwrap().items.is_empty());
    assert_conflict(ships.create(&ship("sr108")).await, "undelete");
    assert_eq!(ships.undelete("sr108").await.unwrap(), made);
    assert_eq!(ships.get("sr108").await.unwrap(), made);
    assert_conflict(ships.create(&ship("sr108")).await, "exists already");
    assert_not_found(ships.undelete("pcc").await, "ship");
}

async fn a_ship_that_is_not_deleted_is_not_restored(on: &TestStore) {
    let made = on.store.ships().create(&ship("kcs")).await.unwrap();
    let before = audited_actions(on).await;
    assert_eq!(on.store.ships().undelete("kcs").await.unwrap(), made);
    assert_eq!(audited_actions(on).await, before, "nothing has changed");
    on.store.ships().delete("kcs", None).await.unwrap();
    on.store.ships().undelete("kcs").await.unwrap();
    assert_eq!(audited_actions(on).await[..2], ["ship.undelete", "ship.delete"]);
}

async fn ships_are_listed_by_category(on: &TestStore) {
    for (name, category) in [("a", "tanker"), ("b", "container"), ("c", "tanker"), ("d", "tanker")]
    {
        on.store
            .ships()
            .create(&NewShip { category: category.into(), ..ship(name) })
            .await
            .unwrap();
    }
    let names = |list: &sistership_store::ListPage<sistership_store::Ship>| -> Vec<String> {
        list.items.iter().map(|ship| ship.name.clone()).collect()
    };
    let first = on.store.ships().list(Some("tanker"), &PageRequest::first_page(2)).await.unwrap();
    assert_eq!((names(&first), first.next.as_deref()), (vec!["a".into(), "c".into()], Some("c")));
    let second =
        on.store.ships().list(Some("tanker"), &PageRequest::after_key("c", 2)).await.unwrap();
    assert_eq!((names(&second), second.next), (vec!["d".into()], None));
    assert_eq!(on.store.ships().list(None, &PageRequest::first_page(4)).await.unwrap().next, None);
}

on_both_databases!(
    a_ship_keeps_its_history,
    only_the_revision_seen_can_be_replaced,
    a_deletion_can_be_undone,
    a_ship_that_is_not_deleted_is_not_restored,
    ships_are_listed_by_category
);
