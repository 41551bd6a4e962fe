use sistership_store::{NewReport, PageRequest};

use crate::support::*;

async fn reports_are_found_by_version(on: &TestStore) {
    let version = versions(on, "kcs", 1).await.remove(0).id;
    let about = NewReport { version_id: Some(version.clone()), ..report("kcs") };
    let first = on.store.reports().insert(&about).await.unwrap();
    let second = on.store.reports().insert(&about).await.unwrap();
    let other = on.store.reports().insert(&report("kcs")).await.unwrap();
    let list = on.store.reports().by_version(&version, &PageRequest::first_page(1)).await.unwrap();
    assert_eq!(list.items, [second]);
    let list = on
        .store
        .reports()
        .by_version(&version, &PageRequest::after_key(list.next.unwrap(), 1))
        .await
        .unwrap();
    assert_eq!((list.items, list.next), (vec![first], None));
    let found = on.store.reports().get(&other.id).await.unwrap();
    assert_eq!(
        (found.head, found.document, found.html),
        (other, report("kcs").document, report("kcs").html)
    );
    assert_not_found(on.store.reports().get("none").await, "report");
}

on_both_databases!(reports_are_found_by_version);
