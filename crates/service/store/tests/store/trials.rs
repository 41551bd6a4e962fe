use serde_json::json;
use sistership_store::{Actor, ChangeKind, NewTrial, ObjectStorage, PageRequest};

use crate::support::*;

async fn the_same_samples_are_one_trial(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    on.store.ships().create(&ship("pcc")).await.unwrap();
    let first = on.store.trials().insert(&trial("kcs", "zigzag")).await.unwrap();
    let again = NewTrial { name: "copy.csv".into(), ..trial("kcs", "zigzag") };
    let again = on.store.trials().insert(&again).await.unwrap();
    assert_eq!((first.new, again.new), (true, false));
    assert_eq!(first.row, again.row);
    assert_eq!(first.row.duration_s, 599.5);
    let other = on.store.trials().insert(&trial("pcc", "zigzag")).await.unwrap();
    assert!(other.new && other.row.id != first.row.id);
    assert_eq!(on.store.trials().find_by_hash("kcs", &first.row.sha256).await.unwrap(), first.row);
}

async fn a_trial_needs_its_ship(on: &TestStore) {
    assert_not_found(on.store.trials().insert(&trial("kcs", "turn")).await, "ship");
    on.store.ships().create(&ship("kcs")).await.unwrap();
    on.store.ships().delete("kcs", None).await.unwrap();
    assert_not_found(on.store.trials().insert(&trial("kcs", "turn")).await, "ship");
}

async fn the_latest_statement_about_a_trial_counts(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let trials = on.store.trials();
    let mut ids = Vec::new();
    for name in ["one", "two"] {
        ids.push(trials.insert(&trial("kcs", name)).await.unwrap().row.id);
    }
    assert_eq!(trials.stated_conditions(&ids[0]).await.unwrap(), None);
    trials.state_conditions("kcs", &ids, &json!({ "place": "Skagerrak" })).await.unwrap();
    let mended = json!({ "place": "Kattegat" });
    trials.state_conditions("kcs", &ids[..1], &mended).await.unwrap();
    assert_eq!(trials.stated_conditions(&ids[0]).await.unwrap(), Some(mended));
    let kept = trials.stated_conditions(&ids[1]).await.unwrap().unwrap();
    assert_eq!(kept["place"], "Skagerrak");
    // A trial of another ship is not there for the caller, and then none is stated.
    let both = [ids[1].clone(), "none".to_owned()];
    assert_not_found(trials.state_conditions("kcs", &both, &json!({})).await, "trial");
    assert_not_found(trials.state_conditions("pcc", &ids, &json!({})).await, "trial");
    assert_eq!(trials.stated_conditions(&ids[1]).await.unwrap(), Some(kept));
}

async fn recent_changes_are_those_of_people(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let ann = Actor::new("ann", "192.0.2.1");
    let upload = async { on.store.trials().insert(&trial("kcs", "one")).await.unwrap() };
    let at_us = ann.run_scoped(upload).await.row.created_us;
    let changes = on.store.recent_changes(0).await.unwrap();
    let kinds: Vec<_> = changes.iter().map(|one| (one.ship.as_str(), &one.kind)).collect();
    assert_eq!(kinds, [("kcs", &ChangeKind::TrialUploaded)], "the program has added the ship");
    assert_eq!(on.store.recent_changes(at_us + 1).await.unwrap(), []);
}

async fn several_trials_are_put_in_all_or_none(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let batch = [trial("kcs", "one"), trial("nobody", "two")];
    assert_not_found(on.store.trials().insert_all(&batch).await, "ship");
    assert!(
        on.store.trials().list("kcs", &PageRequest::first_page(10)).await.unwrap().items.is_empty()
    );
    let inserted = on
        .store
        .trials()
        .insert_all(&[trial("kcs", "one"), trial("kcs", "two"), trial("kcs", "one")])
        .await
        .unwrap();
    assert_eq!(inserted.iter().map(|one| one.new).collect::<Vec<_>>(), [true, true, false]);
}

async fn a_job_follows_trials_or_both_are_undone(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let objects = ObjectStorage::in_memory();
    let one = [trial("kcs", "one")];
    assert_not_found(
        on.store.trials().insert_all_and_enqueue(&one, &objects, |_| None).await,
        "object",
    );
    assert!(
        on.store.trials().list("kcs", &PageRequest::first_page(10)).await.unwrap().items.is_empty(),
        "no trial without samples"
    );
    for samples in ["one", "two"] {
        objects.put(samples.into()).await.unwrap();
    }
    let asked = |inserted: &[sistership_store::InsertOutcome<_>]| {
        inserted.iter().any(|one| one.new).then(|| job("kcs"))
    };
    let (_, queued) =
        on.store.trials().insert_all_and_enqueue(&one, &objects, asked).await.unwrap();
    assert_eq!(queued.unwrap().ship.as_deref(), Some("kcs"));
    let (_, queued) =
        on.store.trials().insert_all_and_enqueue(&one, &objects, asked).await.unwrap();
    assert_eq!(queued, None, "nothing new, nothing to do");
    let broken = |_: &[_]| Some(sistership_store::NewJob { request: "{".into(), ..job("kcs") });
    assert_invalid(
        on.store.trials().insert_all_and_enqueue(&[trial("kcs", "two")], &objects, broken).await,
        "request",
    );
    assert_eq!(
        on.store.trials().list("kcs", &PageRequest::first_page(10)).await.unwrap().items.len(),
        1
    );
}

async fn a_deleted_trial_comes_back(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let trials = on.store.trials();
    let made = trials.insert(&trial("kcs", "turn")).await.unwrap().row;
    assert!(trials.delete(&made.id).await.unwrap().deleted_us.is_some());
    assert_not_found(trials.get(&made.id).await, "trial");
    assert_not_found(trials.find_by_hash("kcs", &made.sha256).await, "trial");
    assert_not_found(trials.delete(&made.id).await, "trial");
    assert!(trials.list("kcs", &PageRequest::first_page(10)).await.unwrap().items.is_empty());
    assert_eq!(trials.undelete(&made.id).await.unwrap(), made);
    trials.delete(&made.id).await.unwrap();
    let again = trials.insert(&trial("kcs", "turn")).await.unwrap();
    assert_eq!((again.row, again.new), (made.clone(), false));
    assert_eq!(trials.get(&made.id).await.unwrap(), made);
}

async fn every_restoration_of_a_trial_is_audited_once(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let trials = on.store.trials();
    let made = trials.insert(&trial("kcs", "turn")).await.unwrap().row;
    let before = audited_actions(on).await;
    assert_eq!(trials.undelete(&made.id).await.unwrap(), made, "it is not deleted");
    trials.insert(&trial("kcs", "turn")).await.unwrap();
    assert_eq!(audited_actions(on).await, before, "nothing has changed");
    trials.delete(&made.id).await.unwrap();
    trials.insert(&trial("kcs", "turn")).await.unwrap();
    assert_eq!(audited_actions(on).await[..2], ["trial.undelete", "trial.delete"]);
    assert_not_found(trials.undelete("nothing").await, "trial");
}

async fn trials_are_listed_in_the_order_of_upload(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    for n in 0..5 {
        on.store.trials().insert(&trial("kcs", &n.to_string())).await.unwrap();
    }
    let first = on.store.trials().list("kcs", &PageRequest::first_page(3)).await.unwrap();
    let second = on
        .store
        .trials()
        .list("kcs", &PageRequest::after_key(first.next.unwrap(), 3))
        .await
        .unwrap();
    let names: Vec<_> =
        first.items.iter().chain(&second.items).map(|trial| trial.name.as_str()).collect();
    assert_eq!(names, ["0.csv", "1.csv", "2.csv", "3.csv", "4.csv"]);
    assert_eq!(second.next, None);
}

on_both_databases!(
    the_same_samples_are_one_trial,
    a_trial_needs_its_ship,
    the_latest_statement_about_a_trial_counts,
    recent_changes_are_those_of_people,
    several_trials_are_put_in_all_or_none,
    a_job_follows_trials_or_both_are_undone,
    a_deleted_trial_comes_back,
    every_restoration_of_a_trial_is_audited_once,
    trials_are_listed_in_the_order_of_upload
);
