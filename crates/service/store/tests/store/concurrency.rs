use std::collections::HashSet;
use std::sync::Arc;

use futures::future::join_all;
use sistership_store::{
    ExpectedRevision, JobClaim, PageRequest, RequestClaim, Store, StoreError, SystemClock,
    WorkerClaim, sha256_hex,
};

use crate::support::*;

async fn fifty_creators_leave_no_gap(on: &TestStore) {
    let other = Store::connect(&on.database.url, Arc::new(SystemClock)).await.unwrap();
    let creators = (0..50).map(|n| {
        let store = if n % 2 == 0 { on.store.clone() } else { other.clone() };
        tokio::spawn(async move {
            store
                .versions()
                .create(&version("kcs"), &[champion(ExpectedRevision::Any)])
                .await
                .unwrap()
                .number
        })
    });
    let mut numbers: Vec<_> = join_all(creators).await.into_iter().map(Result::unwrap).collect();
    numbers.sort_unstable();
    assert_eq!(numbers, (1..=50).collect::<Vec<_>>());
    let history = on
        .store
        .aliases()
        .list_history("kcs", "champion", &PageRequest::first_page(100))
        .await
        .unwrap()
        .items;
    assert!(history.windows(2).all(|pair| pair[0].from_number == Some(pair[1].to_number)));
}

async fn a_hundred_movers_have_one_winner(on: &TestStore) {
    versions(on, "kcs", 2).await;
    let other = Store::connect(&on.database.url, Arc::new(SystemClock)).await.unwrap();
    for round in 0..5 {
        let expect =
            if round == 0 { ExpectedRevision::Absent } else { ExpectedRevision::Revision(round) };
        let movers = (0..100).map(|n| {
            let store = if n % 2 == 0 { on.store.clone() } else { other.clone() };
            tokio::spawn(async move { store.aliases().move_to("kcs", 2, &champion(expect)).await })
        });
        let results: Vec<_> = join_all(movers).await.into_iter().map(Result::unwrap).collect();
        let revision = round + 1;
        let stale = |result| matches!(result, &Err(StoreError::PreconditionFailed { current, .. }) if current == Some(revision));
        let counts = (
            results.iter().filter(|result| result.is_ok()).count(),
            results.iter().filter(|result| stale(result)).count(),
        );
        assert_eq!(counts, (1, 99), "in round {round}: {results:?}");
    }
}

async fn no_job_is_claimed_twice(on: &TestStore) {
    for _ in 0..20 {
        on.store.jobs().enqueue(&job("kcs")).await.unwrap();
    }
    let workers = (0..30).map(|n| {
        let store = on.store.clone();
        tokio::spawn(async move {
            store
                .jobs()
                .claim_next(&WorkerClaim {
                    alone: false,
                    ..crate::jobs::any_job(&format!("worker-{n}"))
                })
                .await
                .unwrap()
        })
    });
    let id = |claimed| if let JobClaim::Job(job) = claimed { Some(job.id) } else { None };
    let claimed: Vec<_> =
        join_all(workers).await.into_iter().filter_map(|claim| id(claim.unwrap())).collect();
    assert_eq!((claimed.len(), claimed.iter().collect::<HashSet<_>>().len()), (20, 20));
}

async fn one_of_many_requests_is_carried_out(on: &TestStore) {
    let requests = (0..30).map(|_| {
        let store = on.store.clone();
        tokio::spawn(async move {
            store
                .idempotency()
                .begin_request("POST /v1/ships", "k", &sha256_hex(b""))
                .await
                .unwrap()
        })
    });
    let begun: Vec<_> = join_all(requests).await.into_iter().map(Result::unwrap).collect();
    assert_eq!(begun.iter().filter(|begun| matches!(begun, RequestClaim::New(_))).count(), 1);
    assert_eq!(begun.iter().filter(|begun| **begun == RequestClaim::InProgress).count(), 29);
}

async fn one_upload_of_many_is_new(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    let uploads = (0..20).map(|_| {
        let store = on.store.clone();
        tokio::spawn(async move { store.trials().insert(&trial("kcs", "turn")).await.unwrap() })
    });
    let inserted: Vec<_> = join_all(uploads).await.into_iter().map(Result::unwrap).collect();
    assert_eq!(inserted.iter().filter(|inserted| inserted.new).count(), 1);
    assert!(inserted.iter().all(|other| other.row == inserted[0].row));
}

async fn twenty_priors_of_a_family_get_twenty_revisions(on: &TestStore) {
    let foundation = versions(on, "foundation", 1).await.remove(0).id;
    on.store.families().create("sisters", "Sisters", &foundation).await.unwrap();
    let other = Store::connect(&on.database.url, Arc::new(SystemClock)).await.unwrap();
    let learners = (0..20).map(|n| {
        let store = if n % 2 == 0 { on.store.clone() } else { other.clone() };
        tokio::spawn(async move { store.families().insert_prior("sisters", "{}").await })
    });
    let mut revisions: Vec<_> = join_all(learners)
        .await
        .into_iter()
        .map(|prior| prior.unwrap().unwrap().revision)
        .collect();
    revisions.sort_unstable();
    assert_eq!(revisions, (1..=20).collect::<Vec<_>>());
}

on_both_databases!(
    twenty_priors_of_a_family_get_twenty_revisions,
    fifty_creators_leave_no_gap,
    a_hundred_movers_have_one_winner,
    no_job_is_claimed_twice,
    one_of_many_requests_is_carried_out,
    one_upload_of_many_is_new
);
