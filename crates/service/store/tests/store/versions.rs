use sistership_store::{ExpectedRevision, NewVersion, PageRequest, sha256_hex};

use crate::support::*;

async fn a_version_is_found_again(on: &TestStore) {
    let store = on.store.versions();
    let head = store.create(&version("kcs"), &[champion(ExpectedRevision::Absent)]).await.unwrap();
    assert_eq!(
        (head.number, head.sha256.as_str()),
        (1, sha256_hex(version("kcs").document.as_bytes()).as_str())
    );
    let found = store.get("kcs", 1).await.unwrap();
    assert_eq!((&found.head, &found.document), (&head, &version("kcs").document));
    assert_eq!(store.by_id(&head.id).await.unwrap(), found);
    assert_eq!(store.latest("kcs").await.unwrap(), found);
    assert_eq!(on.store.aliases().get("kcs", "champion").await.unwrap().version_number, 1);
    assert_not_found(store.get("kcs", 2).await, "version");
    assert_not_found(store.by_id("none").await, "version");
    assert_not_found(store.latest("pcc").await, "model");
}

async fn each_model_counts_for_itself_and_newest_first(on: &TestStore) {
    versions(on, "kcs", 5).await;
    versions(on, "pcc", 1).await;
    let first = on.store.versions().list("kcs", &PageRequest::first_page(3)).await.unwrap();
    let second = on
        .store
        .versions()
        .list("kcs", &PageRequest::after_key(first.next.unwrap(), 3))
        .await
        .unwrap();
    let numbers: Vec<_> =
        first.items.iter().chain(&second.items).map(|version| version.number).collect();
    assert_eq!((numbers, second.next), (vec![5, 4, 3, 2, 1], None));
    assert_eq!(on.store.versions().latest("pcc").await.unwrap().head.number, 1);
}

async fn versions_are_signed_by_people(on: &TestStore) {
    versions(on, "kcs", 1).await;
    let store = on.store.versions();
    assert_eq!(store.list_sign_offs("kcs", 1).await.unwrap(), []);
    store.sign_off("kcs", 1, "checked", "Ann Smith").await.unwrap();
    store.sign_off("kcs", 1, "approved", "Bob Jones").await.unwrap();
    let signed = store.list_sign_offs("kcs", 1).await.unwrap();
    let names: Vec<_> = signed.iter().map(|one| (one.role.as_str(), one.person.as_str())).collect();
    assert_eq!(names, [("approved", "Bob Jones"), ("checked", "Ann Smith")]);
    assert_invalid(store.sign_off("kcs", 1, "liked", "Ann").await, "role");
    assert_invalid(store.sign_off("kcs", 1, "checked", " ").await, "person");
    assert_not_found(store.sign_off("kcs", 2, "checked", "Ann").await, "version");
}

async fn children_name_their_parent(on: &TestStore) {
    let parent = versions(on, "kvlcc2", 1).await.remove(0).id;
    for model in ["kvlcc2", "esso-tanker"] {
        let child = NewVersion { parent: Some(parent.clone()), ..version(model) };
        on.store.versions().create(&child, &[]).await.unwrap();
    }
    let children = on
        .store
        .versions()
        .list_children(&parent, &PageRequest::first_page(10))
        .await
        .unwrap()
        .items;
    let models: Vec<_> =
        children.iter().map(|child| (child.model.as_str(), child.number)).collect();
    assert_eq!(models, [("kvlcc2", 2), ("esso-tanker", 1)]);
    let orphan = NewVersion { parent: Some("none".into()), ..version("kvlcc2") };
    assert_invalid(on.store.versions().create(&orphan, &[]).await, "parent");
}

async fn a_refused_alias_takes_no_number(on: &TestStore) {
    versions(on, "kcs", 1).await;
    let refused = on
        .store
        .versions()
        .create(&version("kcs"), &[champion(ExpectedRevision::Revision(7))])
        .await;
    assert_stale(refused, None);
    assert_eq!(versions(on, "kcs", 1).await[0].number, 2);
}

on_both_databases!(
    versions_are_signed_by_people,
    a_version_is_found_again,
    each_model_counts_for_itself_and_newest_first,
    children_name_their_parent,
    a_refused_alias_takes_no_number
);
