use sistership_store::{AliasMove, ExpectedRevision, PageRequest};

use crate::support::*;

async fn an_alias_moves_by_compare_and_swap(on: &TestStore) {
    versions(on, "kcs", 3).await;
    let aliases = on.store.aliases();
    assert_stale(aliases.move_to("kcs", 1, &champion(ExpectedRevision::Revision(1))).await, None);
    assert_eq!(
        aliases.move_to("kcs", 1, &champion(ExpectedRevision::Absent)).await.unwrap().revision,
        1
    );
    assert_stale(aliases.move_to("kcs", 2, &champion(ExpectedRevision::Absent)).await, Some(1));
    assert_eq!(
        aliases.move_to("kcs", 2, &champion(ExpectedRevision::Revision(1))).await.unwrap().revision,
        2
    );
    assert_stale(
        aliases.move_to("kcs", 3, &champion(ExpectedRevision::Revision(1))).await,
        Some(2),
    );
    let alias = aliases.move_to("kcs", 3, &champion(ExpectedRevision::Any)).await.unwrap();
    assert_eq!((alias.version_number, alias.revision), (3, 3));
    assert_eq!(aliases.get("kcs", "champion").await.unwrap(), alias);
}

async fn an_alias_remembers_its_moves(on: &TestStore) {
    versions(on, "kcs", 2).await;
    for to in [1, 2, 1] {
        on.store.aliases().move_to("kcs", to, &champion(ExpectedRevision::Any)).await.unwrap();
    }
    let first = on
        .store
        .aliases()
        .list_history("kcs", "champion", &PageRequest::first_page(2))
        .await
        .unwrap();
    let second = on
        .store
        .aliases()
        .list_history("kcs", "champion", &PageRequest::after_key(first.next.unwrap(), 2))
        .await
        .unwrap();
    let moves: Vec<_> = first
        .items
        .iter()
        .chain(&second.items)
        .map(|change| (change.revision, change.from_number, change.to_number))
        .collect();
    assert_eq!(moves, [(3, Some(2), 1), (2, Some(1), 2), (1, None, 1)]);
    assert_eq!((first.items[0].reason.as_str(), first.items[0].actor.as_str()), ("better", "ann"));
}

async fn an_alias_stands_for_a_version_that_exists(on: &TestStore) {
    versions(on, "kcs", 1).await;
    assert_not_found(
        on.store.aliases().move_to("kcs", 2, &champion(ExpectedRevision::Any)).await,
        "version",
    );
    assert_not_found(
        on.store.aliases().move_to("pcc", 1, &champion(ExpectedRevision::Any)).await,
        "model",
    );
    assert_not_found(on.store.aliases().get("kcs", "champion").await, "alias");
    assert!(
        on.store
            .aliases()
            .list("kcs", &PageRequest::first_page(10))
            .await
            .unwrap()
            .items
            .is_empty()
    );
}

async fn aliases_are_listed(on: &TestStore) {
    versions(on, "kcs", 1).await;
    for alias in ["champion", "candidate", "best-in-wind"] {
        let change = AliasMove { alias: alias.into(), ..champion(ExpectedRevision::Absent) };
        on.store.aliases().move_to("kcs", 1, &change).await.unwrap();
    }
    let list = on.store.aliases().list("kcs", &PageRequest::first_page(2)).await.unwrap();
    let names: Vec<_> = list.items.iter().map(|alias| alias.alias.as_str()).collect();
    assert_eq!(
        (names, list.next.as_deref()),
        (vec!["best-in-wind", "candidate"], Some("candidate"))
    );
}

on_both_databases!(
    an_alias_moves_by_compare_and_swap,
    an_alias_remembers_its_moves,
    an_alias_stands_for_a_version_that_exists,
    aliases_are_listed
);
