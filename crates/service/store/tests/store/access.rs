//! Users, service keys, sessions and roles, and what the audit has of them.

use sistership_store::{
    Actor, AuditFilter, ExpectedRevision, GrantRow, KeyRow, NewKey, PageRequest, SignIn,
    StoreError, User, sha256_hex,
};

use crate::support::*;

fn role(kind: &str, name: &str, role: &str) -> GrantRow {
    GrantRow { scope_kind: kind.into(), scope_name: name.into(), role: role.into() }
}

fn key(user: Option<&str>) -> NewKey {
    NewKey {
        prefix: "0123456789ab".into(),
        title: "A logger".into(),
        user: user.map(str::to_owned),
        sha256: sha256_hex(b"secret"),
        expires_us: None,
    }
}

/// Actions and actors, the first first.
async fn audited(on: &TestStore) -> Vec<(String, String)> {
    let entries =
        on.store.audit().list(AuditFilter::All, &PageRequest::first_page(100)).await.unwrap();
    entries.items.into_iter().rev().map(|entry| (entry.action, entry.actor)).collect()
}

async fn users_keep_their_names(on: &TestStore) {
    let users = on.store.users();
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let roles = [role("server", "", "reader"), role("ship", "kcs", "engineer")];
    let ann = users.create("ann", "Ann", Some("hash"), &roles).await.unwrap();
    assert!(ann.is_enabled());
    assert_conflict(users.create("ann", "Another", None, &[]).await, "already");
    assert_eq!(
        on.store.grants().list_by_principal(&User::principal_name("ann")).await.unwrap(),
        roles
    );
    let nowhere = [role("ship", "nobody", "reader")];
    assert_invalid(users.create("bob", "Bob", None, &nowhere).await, "roles");
    assert_not_found(users.get("bob").await, "user");
    assert_invalid(on.store.grants().replace_roles("user:ann", &nowhere).await, "roles");
    assert_eq!(
        on.store.grants().list_by_principal("user:ann").await.unwrap().len(),
        2,
        "nothing is half done"
    );
    on.store.grants().replace_roles("user:ann", &roles[..1]).await.unwrap();
    assert_eq!(on.store.grants().list_by_principal("user:ann").await.unwrap(), roles[..1]);
    assert_not_found(on.store.grants().replace_roles("user:bob", &[]).await, "user or key");
    users.disable("ann").await.unwrap();
    assert_conflict(users.disable("ann").await, "disabled");
    assert_not_found(on.store.grants().replace_roles("user:ann", &[]).await, "user or key");
    assert!(!users.get("ann").await.unwrap().is_enabled());
    users.enable("ann").await.unwrap();
    assert_conflict(users.enable("ann").await, "enabled");
    assert_not_found(users.disable("bob").await, "user");
    assert_eq!(users.list(&PageRequest::first_page(1)).await.unwrap().items[0].name, "ann");
}

async fn sessions_end(on: &TestStore) {
    on.store.users().create("ann", "Ann", Some("hash"), &[]).await.unwrap();
    let (sessions, hash) = (on.store.sessions(), sha256_hex(b"cookie"));
    let later = on.store.now_us() + 1000;
    sessions.begin_session(&hash, "ann", later).await.unwrap();
    assert_eq!(sessions.find(&hash).await.unwrap().unwrap().user_name, "ann");
    on.clock.advance(std::time::Duration::from_millis(1));
    assert_eq!(sessions.find(&hash).await.unwrap(), None, "by itself");
    for end in ["end", "password", "disable"] {
        let hash = sha256_hex(end.as_bytes());
        sessions.begin_session(&hash, "ann", i64::MAX).await.unwrap();
        match end {
            "end" => sessions.end_session(&hash).await.unwrap(),
            "password" => drop(on.store.users().set_password("ann", "other").await.unwrap()),
            _ => drop(on.store.users().disable("ann").await.unwrap()),
        }
        assert_eq!(sessions.find(&hash).await.unwrap(), None, "{end}");
    }
}

/// Somebody whom a provider knows, by the sign-in of this name.
fn sign_in<'a>(subject: &'a str, sha256: &'a str) -> SignIn<'a> {
    SignIn { issuer: "https://id.example", subject, sha256, expires_us: 1_900_000_000_000_000 }
}

async fn an_identity_is_one_users(on: &TestStore) {
    let (users, identities) = (on.store.users(), on.store.identities());
    for name in ["ann", "bob"] {
        users.create(name, name, None, &[]).await.unwrap();
    }
    let hashes: Vec<String> = (0..8_u8).map(|n| sha256_hex(&[n])).collect();
    let own = ("https://id.example".to_owned(), "7-of-9".to_owned());
    identities.replace_identities("ann", std::slice::from_ref(&own)).await.unwrap();
    let found = identities.find(&own.0, &own.1).await.unwrap().unwrap();
    assert_eq!(found.user_name, "ann");
    assert_eq!(identities.find("https://other.example", &own.1).await.unwrap(), None);
    assert_conflict(
        identities.replace_identities("bob", std::slice::from_ref(&own)).await,
        "another user",
    );
    assert_conflict(
        identities.link_identity("bob", sign_in("7-of-9", &hashes[0])).await,
        "another user",
    );
    identities.link_identity("bob", sign_in("1-of-9", &hashes[0])).await.unwrap();
    assert_conflict(
        identities.link_identity("bob", sign_in("2-of-9", &hashes[0])).await,
        "ended already",
    );
    assert_eq!(identities.list_by_user("bob").await.unwrap().len(), 1, "nothing is half done");
    let roles = [role("server", "", "reader")];
    let eve = sign_in("3-of-9", &hashes[1]);
    identities.create_user("eve", "Eve", &roles, eve).await.unwrap();
    assert_conflict(
        identities.create_user("ann", "Ann", &[], sign_in("4", &hashes[2])).await,
        "name",
    );
    assert_eq!(identities.find(&own.0, "4").await.unwrap(), None);
    assert_eq!(on.store.grants().list_by_principal("user:eve").await.unwrap(), roles);
    assert!(users.get("eve").await.unwrap().password_hash.is_none());
    assert_not_found(identities.replace_identities("nobody", &[]).await, "user");
    for wrong in ["", "a\nb", &"a".repeat(256)] {
        let pair = (own.0.clone(), wrong.to_owned());
        assert_invalid(identities.replace_identities("bob", &[pair]).await, "subject");
    }
    let actions: Vec<String> = audited(on).await.into_iter().map(|(action, _)| action).collect();
    let expected =
        ["user.create", "user.create", "user.identities", "user.identity", "user.create"];
    assert_eq!(actions, expected);
}

async fn a_sign_in_at_a_provider_ends_once(on: &TestStore) {
    on.store.users().create("ann", "Ann", None, &[]).await.unwrap();
    let (identities, session) = (on.store.identities(), sha256_hex(b"cookie"));
    let (first, second) = (sha256_hex(b"1"), sha256_hex(b"2"));
    let once = sign_in("7-of-9", &first);
    identities.begin_session(&session, "ann", i64::MAX, once).await.unwrap();
    let again = identities.begin_session(&sha256_hex(b"other"), "ann", i64::MAX, once).await;
    assert_conflict(again, "ended already");
    assert!(on.store.sessions().find(&sha256_hex(b"other")).await.unwrap().is_none());
    assert_conflict(identities.record_refusal(once, "why").await, "ended already");
    identities.record_refusal(sign_in("7-of-9", &second), "no account").await.unwrap();
    let entries =
        on.store.audit().list(AuditFilter::All, &PageRequest::first_page(2)).await.unwrap().items;
    assert_eq!((&*entries[0].action, &*entries[1].action), ("session.refuse", "session.begin"));
    let after = entries[0].state_after.as_deref().unwrap();
    assert!(after.contains("no account") && after.contains("https://id.example"), "{after}");
    assert!(entries[1].state_after.as_deref().unwrap().contains("7-of-9"));
    // Known as nobody any more, signed out.
    let own = ("https://id.example".to_owned(), "7-of-9".to_owned());
    identities.replace_identities("ann", &[own]).await.unwrap();
    assert!(on.store.sessions().find(&session).await.unwrap().is_some());
    identities.replace_identities("ann", &[]).await.unwrap();
    assert!(on.store.sessions().find(&session).await.unwrap().is_none());
}

async fn keys_end_for_ever(on: &TestStore) {
    let keys = on.store.service_keys();
    assert_invalid(keys.create(&key(Some("nobody")), &[]).await, "user");
    let roles = [role("server", "", "engineer")];
    let made = keys.create(&key(None), &roles).await.unwrap();
    let now = on.store.now_us();
    assert!(made.is_valid(now) && made.last_used_us.is_none());
    assert!(!KeyRow { expires_us: Some(now), ..made.clone() }.is_valid(now));
    assert_eq!(
        on.store.grants().list_by_principal(&KeyRow::principal_name(&made.prefix)).await.unwrap(),
        roles
    );
    keys.record_use(&made.prefix).await.unwrap();
    assert_eq!(keys.get(&made.prefix).await.unwrap().last_used_us, Some(now));
    assert!(!keys.revoke(&made.prefix).await.unwrap().is_valid(now));
    assert_conflict(keys.revoke(&made.prefix).await, "revoked already");
    assert_not_found(keys.revoke("nothing").await, "key");
    assert_eq!(keys.list(&PageRequest::first_page(10)).await.unwrap().items.len(), 1);
}

async fn what_is_done_is_in_the_audit_and_what_is_not_is_not(on: &TestStore) {
    let ann = || Actor::new("ann", "192.0.2.1");
    ann().run_scoped(async { on.store.ships().create(&ship("kcs")).await }).await.unwrap();
    assert_conflict(on.store.ships().create(&ship("kcs")).await, "already");
    on.store
        .versions()
        .create(&version("kcs"), &[champion(ExpectedRevision::Absent)])
        .await
        .unwrap();
    on.store.ships().add_tag("kcs", "own").await.unwrap();
    on.store.ships().add_tag("kcs", "own").await.unwrap();
    let program = "sistership";
    let expected = [
        ("ship.create", "ann"),
        ("version.create", program),
        ("alias.move", program),
        ("ship.tag", program),
    ];
    let expected = expected.map(|(action, actor)| (action.to_owned(), actor.to_owned()));
    assert_eq!(audited(on).await, expected);
    let of = |filter| async move {
        on.store.audit().list(filter, &PageRequest::first_page(10)).await.unwrap().items
    };
    let entries = of(AuditFilter::Actor("ann")).await;
    assert_eq!((entries.len(), entries[0].origin.as_str()), (1, "192.0.2.1"));
    let entries = of(AuditFilter::Subject("alias:kcs/champion")).await;
    assert_eq!(entries[0].state_before, None);
    assert!(entries[0].state_after.as_ref().unwrap().contains(r#""version":1"#), "{entries:?}");
    let (count, faults) = on.store.audit().find_faults(None).await.unwrap();
    assert_eq!((count, faults.len()), (4, 0));
    let head = on.store.audit().chain_head().await.unwrap();
    assert_eq!((head.number, head.sha256.len()), (4, 64));
}

async fn a_unit_of_work_is_entered_as_a_whole_or_not_at_all(on: &TestStore) {
    let unit = on.store.begin_unit();
    unit.store().ships().create(&ship("a")).await.unwrap();
    unit.store().ships().create(&ship("a")).await.unwrap_err();
    unit.store().ships().create(&ship("b")).await.unwrap();
    unit.commit(None).await.unwrap();
    let unit = on.store.begin_unit();
    unit.store().ships().create(&ship("c")).await.unwrap();
    unit.rollback().await;
    let subjects: Vec<String> = on
        .store
        .audit()
        .list(AuditFilter::All, &PageRequest::first_page(10))
        .await
        .unwrap()
        .items
        .into_iter()
        .map(|entry| entry.subject)
        .collect();
    assert_eq!(subjects, ["ship:b", "ship:a"]);
    assert_eq!(on.store.audit().find_faults(None).await.unwrap().1, []);
}

async fn many_enter_at_once_and_each_has_its_number(on: &TestStore) {
    let writing = (0..24).map(|n| {
        let store = on.store.clone();
        tokio::spawn(async move {
            match n % 3 {
                0 => {
                    let unit = store.begin_unit();
                    for part in ["a", "b"] {
                        let name = format!("ship-{n}-{part}");
                        unit.store().ships().create(&ship(&name)).await.unwrap();
                    }
                    unit.commit(None).await.unwrap();
                }
                _ => drop(store.ships().create(&ship(&format!("ship-{n}"))).await.unwrap()),
            }
        })
    });
    for done in futures::future::join_all(writing).await {
        done.unwrap();
    }
    let (count, faults) = on.store.audit().find_faults(None).await.unwrap();
    assert_eq!((count, faults), (32, vec![]));
}

/// Each way in which entries may be other than they were entered.
const TAMPERING: &[&str] = &[
    "UPDATE audit SET actor = 'bob' WHERE number = 2",
    "UPDATE audit SET state_after = NULL WHERE number = 1",
    "UPDATE audit SET at_us = at_us + 1 WHERE number = 3",
    "DELETE FROM audit WHERE number = 2",
    "DELETE FROM audit WHERE number = 3",
    "DELETE FROM audit",
    "UPDATE audit SET number = 4 WHERE number = 3",
    "UPDATE audit SET sha256 = previous_sha256 WHERE number = 3",
    "UPDATE audit_head SET number = 2, sha256 = (SELECT sha256 FROM audit WHERE number = 2)",
    "DELETE FROM audit_head",
];

async fn tampering_with_one_entry_is_found(database: impl AsyncFn() -> Option<TestDatabase>) {
    for damage in TAMPERING {
        let Some(database) = database().await else { return };
        let on = database.open().await;
        for name in ["a", "b", "c"] {
            on.store.ships().create(&ship(name)).await.unwrap();
        }
        assert_eq!(on.store.audit().find_faults(None).await.unwrap().1, [], "{damage}");
        on.database.execute_unchecked(damage).await;
        let faults = on.store.audit().find_faults(None).await.unwrap().1;
        assert!(!faults.is_empty(), "{damage}");
        assert!(faults.iter().all(|fault| fault.check == "audit-chain"), "{faults:?}");
    }
}

#[tokio::test]
async fn tampering_is_found_on_sqlite() {
    tampering_with_one_entry_is_found(async || Some(TestDatabase::new_sqlite())).await;
}

#[tokio::test]
async fn tampering_is_found_on_postgres() {
    tampering_with_one_entry_is_found(TestDatabase::new_postgres).await;
}

async fn a_second_person_is_asked_for_where_that_is_set(on: &TestStore) {
    let ann = || Actor::new("ann", "::1");
    ann().run_scoped(versions(on, "kcs", 2)).await;
    assert_eq!(on.store.versions().get_head("kcs", 1).await.unwrap().author, "ann");
    let promote = |actor: Actor, to| async move {
        let moves = on.store.aliases();
        actor.run_scoped(moves.move_to("kcs", to, &champion(ExpectedRevision::Any))).await
    };
    promote(ann(), 1).await.unwrap();
    on.store.settings().set_second_person(true).await.unwrap();
    assert!(on.store.settings().requires_second_person().await.unwrap());
    match promote(ann(), 2).await {
        Err(StoreError::Forbidden { message }) => assert!(message.contains("made by ann")),
        other => panic!("{other:?}"),
    }
    promote(Actor::new("bob", "::1"), 2).await.unwrap();
    let mine =
        sistership_store::AliasMove { alias: "mine".into(), ..champion(ExpectedRevision::Any) };
    ann().run_scoped(on.store.aliases().move_to("kcs", 1, &mine)).await.unwrap();
    on.store.settings().set_second_person(false).await.unwrap();
    promote(ann(), 1).await.unwrap();
}

async fn jobs_and_versions_have_authors(on: &TestStore) {
    let job =
        Actor::new("ann", "::1").run_scoped(on.store.jobs().enqueue(&job("kcs"))).await.unwrap();
    assert_eq!(job.author, "ann");
}

on_both_databases!(
    users_keep_their_names,
    sessions_end,
    an_identity_is_one_users,
    a_sign_in_at_a_provider_ends_once,
    keys_end_for_ever,
    what_is_done_is_in_the_audit_and_what_is_not_is_not,
    a_unit_of_work_is_entered_as_a_whole_or_not_at_all,
    many_enter_at_once_and_each_has_its_number,
    a_second_person_is_asked_for_where_that_is_set,
    jobs_and_versions_have_authors,
);
