use sistership_store::{PageRequest, sha256_hex};

use crate::support::*;

async fn a_law_never_changes(on: &TestStore) {
    let laws = on.store.laws();
    let law = laws.insert("abkowitz", "X: {}\n").await.unwrap();
    assert_eq!(law.sha256, sha256_hex(b"X: {}\n"));
    assert_eq!(laws.insert("abkowitz", "X: {}\n").await.unwrap(), law);
    assert_conflict(laws.insert("abkowitz", "Y: {}\n").await, "cannot be changed");
    assert_eq!(laws.get("abkowitz").await.unwrap().document, "X: {}\n");
    assert_not_found(laws.get("mmg").await, "law");
}

async fn laws_are_listed_byte_by_byte(on: &TestStore) {
    for name in ["b", "a", "Z", "a-2", "é"] {
        on.store.laws().insert(name, name).await.unwrap();
    }
    let (mut names, mut page) = (Vec::new(), PageRequest::first_page(2));
    loop {
        let list = on.store.laws().list(&page).await.unwrap();
        names.extend(list.items.into_iter().map(|law| law.name));
        let Some(next) = list.next else { break };
        page = PageRequest::after_key(next, 2);
    }
    assert_eq!(names, ["Z", "a", "a-2", "b", "é"]);
}

on_both_databases!(a_law_never_changes, laws_are_listed_byte_by_byte);
