use sistership_store::{
    AliasMove, AuditFilter, ExpectedRevision, Job, JobState, NewOutcome, PageRequest, Result,
};

use crate::jobs::{claim, let_the_lease_run_out};
use crate::support::*;

async fn family(on: &TestStore, ships: &[&str]) -> Vec<String> {
    for name in ships {
        on.store.ships().create(&ship(name)).await.unwrap();
    }
    let foundation = versions(on, "foundation", 1).await.remove(0).id;
    on.store.families().create("sisters", "Sisters", &foundation).await.unwrap();
    let ships: Vec<String> = ships.iter().map(|&name| name.to_owned()).collect();
    assert_eq!(
        on.store.families().add_members("sisters", &ships).await.unwrap(),
        ships.len() as u64
    );
    ships
}

async fn bulk(on: &TestStore, chunks: &[Vec<String>]) -> String {
    let chunk =
        |bulk: &str, ships: &[String]| format!(r#"{{"bulk":"{bulk}","ships":{}}}"#, ships.len());
    on.store.bulks().create("sisters", "{}", "bulk-refinement", chunks, chunk).await.unwrap().id
}

fn outcome(ship: &str, moves: Vec<AliasMove>) -> NewOutcome {
    let version = Some((version(ship), moves));
    NewOutcome {
        ship: ship.into(),
        outcome: "candidate".into(),
        version,
        worst_change: Some(-0.1),
        document: "{}".into(),
    }
}

async fn commit(on: &TestStore, bulk: &str, job: &Job, outcomes: &[NewOutcome]) -> Result<Job> {
    on.store.bulks().commit_chunk(bulk, (&job.id, job.fence), outcomes, "{}").await
}

async fn families_have_members_and_teach(on: &TestStore) {
    family(on, &["a", "b", "c"]).await;
    let families = on.store.families();
    assert_invalid(families.add_members("sisters", &["c".into(), "nobody".into()]).await, "ships");
    assert_eq!(
        families.add_members("sisters", &["c".into()]).await.unwrap(),
        0,
        "it is a member already"
    );
    on.store.ships().delete("b", None).await.unwrap();
    let members = families.list_members("sisters", &PageRequest::first_page(2)).await.unwrap();
    assert_eq!(
        members.items.iter().map(|m| m.ship.as_str()).collect::<Vec<_>>(),
        ["a", "c"],
        "a deleted ship is none"
    );
    assert_eq!(
        (families.count_members("sisters").await.unwrap(), members.items[0].champion),
        (2, None)
    );
    assert!(
        families.remove_member("sisters", "a").await.unwrap()
            && !families.remove_member("sisters", "a").await.unwrap()
    );
    assert_conflict(
        families.create("sisters", "Again", &versions(on, "other", 1).await[0].id).await,
        "already",
    );
    assert_not_found(families.get_prior("sisters", None).await, "family prior");
    for revision in 1..=2 {
        let prior =
            families.insert_prior("sisters", &format!(r#"{{"n":{revision}}}"#)).await.unwrap();
        assert_eq!(prior.revision, revision);
    }
    assert_eq!(families.get_prior("sisters", None).await.unwrap().document, r#"{"n":2}"#);
    assert_eq!(families.get_prior("sisters", Some(1)).await.unwrap().document, r#"{"n":1}"#);
    assert_not_found(families.insert_prior("nobody", "{}").await, "family");
}

async fn the_audit_has_the_new_members_of_a_family(on: &TestStore) {
    family(on, &["a", "b"]).await;
    on.store.ships().create(&ship("c")).await.unwrap();
    let ships = ["a".to_owned(), "c".to_owned()];
    assert_eq!(on.store.families().add_members("sisters", &ships).await.unwrap(), 1);
    let page = PageRequest::first_page(1);
    let last = on.store.audit().list(AuditFilter::All, &page).await.unwrap().items.remove(0);
    assert_eq!(
        (last.action.as_str(), last.state_after.as_deref()),
        ("family.add", Some(r#"{"ships":["c"]}"#))
    );
}

async fn statistics_are_kept_once(on: &TestStore) {
    let key = sistership_store::sha256_hex(b"rows");
    assert_eq!(on.store.statistics().get(&key).await.unwrap(), None);
    for document in [r#"{"first":1}"#, r#"{"second":2}"#] {
        on.store.statistics().insert_all(&[(key.clone(), document.to_owned())]).await.unwrap();
    }
    assert_eq!(on.store.statistics().get(&key).await.unwrap().as_deref(), Some(r#"{"first":1}"#));
    assert_invalid(on.store.statistics().insert_all(&[("short".into(), "{}".into())]).await, "key");
}

async fn a_ship_has_one_outcome_whoever_comes_twice(on: &TestStore) {
    let ships = family(on, &["a", "b"]).await;
    let id = bulk(on, &[ships]).await;
    let old = claim(on, "old").await.unwrap();
    let_the_lease_run_out(on).await;
    let new = claim(on, "new").await.unwrap();
    let done = [outcome("a", vec![]), outcome("b", vec![champion(ExpectedRevision::Absent)])];
    assert_conflict(commit(on, &id, &old, &done).await, "no longer valid");
    assert!(
        on.store.bulks().count_outcomes(&id).await.unwrap().is_empty(),
        "a fenced worker leaves nothing behind"
    );
    assert_eq!(commit(on, &id, &new, &done).await.unwrap().state, JobState::Succeeded);
    let outcomes =
        on.store.bulks().list_outcomes(&id, None, &PageRequest::first_page(9)).await.unwrap().items;
    assert_eq!(
        outcomes.iter().map(|o| (o.ship.as_str(), o.version)).collect::<Vec<_>>(),
        [("a", Some(1)), ("b", Some(1))]
    );
    assert_eq!(on.store.versions().latest("a").await.unwrap().head.number, 1);
}

async fn a_chunk_is_kept_whole_or_not_at_all(on: &TestStore) {
    let ships = family(on, &["a", "b"]).await;
    let id = bulk(on, &[ships]).await;
    let job = claim(on, "w").await.unwrap();
    let done = [outcome("a", vec![]), outcome("b", vec![champion(ExpectedRevision::Revision(7))])];
    assert_stale(commit(on, &id, &job, &done).await, None);
    assert!(on.store.bulks().count_outcomes(&id).await.unwrap().is_empty());
    assert_not_found(on.store.versions().latest("a").await, "model");
}

async fn what_is_left_is_cancelled_and_goes_on(on: &TestStore) {
    let ships = family(on, &["a", "b", "c"]).await;
    let chunks: Vec<Vec<String>> = ships.iter().map(|ship| vec![ship.clone()]).collect();
    let id = bulk(on, &chunks).await;
    let first = claim(on, "w").await.unwrap();
    commit(on, &id, &first, &[outcome("a", vec![])]).await.unwrap();
    assert_eq!(on.store.bulks().request_cancel(&id).await.unwrap(), 2);
    let states = |counts: Vec<sistership_store::ChunkCount>| {
        counts.into_iter().map(|c| (c.state, c.jobs)).collect::<Vec<_>>()
    };
    let expected = [(JobState::Cancelled, 2), (JobState::Succeeded, 1)];
    assert_eq!(states(on.store.bulks().count_chunks(&id).await.unwrap()), expected);
    let mut watch = on.store.jobs().watch_queue();
    assert_eq!(on.store.bulks().retry_chunks(&id).await.unwrap(), 2);
    let woken = tokio::time::timeout(std::time::Duration::from_secs(1), watch.wait_queued()).await;
    assert!(woken.is_ok(), "chunks are queued again");
    for ship in ["b", "c"] {
        let job = claim(on, "w").await.unwrap();
        commit(on, &id, &job, &[outcome(ship, vec![])]).await.unwrap();
    }
    assert_eq!(
        states(on.store.bulks().count_chunks(&id).await.unwrap()),
        [(JobState::Succeeded, 3)]
    );
    let word = champion(ExpectedRevision::Any);
    on.store.bulks().promote_candidate(&id, "b", 1, &word).await.unwrap();
    assert_conflict(
        on.store.bulks().promote_candidate(&id, "b", 1, &word).await,
        "not a candidate",
    );
    let counts = on.store.bulks().count_outcomes(&id).await.unwrap();
    assert_eq!(
        counts.into_iter().map(|c| (c.outcome, c.ships)).collect::<Vec<_>>(),
        [("candidate".to_owned(), 2), ("champion".into(), 1)]
    );
}

on_both_databases!(
    families_have_members_and_teach,
    the_audit_has_the_new_members_of_a_family,
    statistics_are_kept_once,
    a_ship_has_one_outcome_whoever_comes_twice,
    a_chunk_is_kept_whole_or_not_at_all,
    what_is_left_is_cancelled_and_goes_on
);
