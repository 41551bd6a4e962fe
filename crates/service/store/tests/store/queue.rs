//! Shares, priorities and quotas of the queue of jobs.

use std::time::Duration;

use futures::future::join_all;
use sistership_store::{Actor, Job, JobClaim, JobState, NewJob, StoreError, WorkerClaim};

use crate::jobs::{any_job, claim};
use crate::support::*;

async fn queue(on: &TestStore, author: &str, new: NewJob) -> Job {
    Actor::new(author, "::1").run_scoped(on.store.jobs().enqueue(&new)).await.unwrap()
}

fn small(ship: &str) -> NewJob {
    NewJob { small: true, ..job(ship) }
}

/// Claims `count` jobs one after the other, each of which ends before the next begins.
async fn authors_and_ships(on: &TestStore, count: usize) -> Vec<String> {
    let mut begun = Vec::new();
    for _ in 0..count {
        on.clock.advance(Duration::from_secs(1));
        let job = claim(on, "a").await.unwrap();
        on.store.jobs().complete(&job.id, job.fence, "{}").await.unwrap();
        begun.push(format!("{}:{}", job.author, job.ship.unwrap()));
    }
    begun
}

async fn an_engineer_with_many_jobs_does_not_delay_others(on: &TestStore) {
    for _ in 0..400 {
        queue(on, "ann", job("kcs")).await;
    }
    claim(on, "a").await.unwrap();
    claim(on, "b").await.unwrap();
    let other = queue(on, "bob", job("pcc")).await;
    let places = on.store.jobs().queue_places().await.unwrap();
    assert_eq!((places.len(), places[0].id.clone(), places[0].place), (399, other.id, 1));
    // While two of ann's jobs run, three of bob's begin before her next one.
    queue(on, "bob", job("pcc")).await;
    queue(on, "bob", job("pcc")).await;
    let mut begun = Vec::new();
    for worker in ["c", "d", "e"] {
        begun.push(claim(on, worker).await.unwrap().author);
    }
    assert_eq!(begun[..2], ["bob", "bob"]);
    assert!(begun.contains(&"bob".to_owned()));
}

async fn authors_and_their_ships_take_turns(on: &TestStore) {
    for ship in ["kcs", "kcs", "kcs", "pcc", "pcc"] {
        queue(on, "ann", job(ship)).await;
    }
    for ship in ["sr108", "sr108"] {
        queue(on, "bob", job(ship)).await;
    }
    let begun = authors_and_ships(on, 7).await;
    let expected =
        ["ann:kcs", "bob:sr108", "ann:pcc", "bob:sr108", "ann:kcs", "ann:pcc", "ann:kcs"];
    assert_eq!(begun, expected);
}

async fn small_jobs_precede_large_ones_that_have_not_waited_long(on: &TestStore) {
    let old = queue(on, "ann", job("kcs")).await.id;
    on.clock.advance(Duration::from_secs(599));
    let (young, little) =
        (queue(on, "ann", job("kcs")).await.id, queue(on, "ann", small("kcs")).await.id);
    on.clock.advance(Duration::from_secs(2));
    let late = queue(on, "ann", small("kcs")).await.id;
    let places = on.store.jobs().queue_places().await.unwrap();
    let order: Vec<&str> = places.iter().map(|place| place.id.as_str()).collect();
    // The old large job has waited longer than ten minutes when the last small one comes.
    assert_eq!(order, [&little, &old, &late, &young].map(String::as_str));
    let only_small = WorkerClaim { small: true, ..any_job("small") };
    for expected in [little, late] {
        match on.store.jobs().claim_next(&only_small).await.unwrap() {
            JobClaim::Job(job) => assert_eq!(job.id, expected),
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(on.store.jobs().claim_next(&only_small).await.unwrap(), JobClaim::Nothing);
}

async fn a_quota_holds_for_requests_at_once(on: &TestStore) {
    let requests = (0..40).map(|_| {
        let store = on.store.clone();
        tokio::spawn(
            Actor::new("ann", "::1")
                .run_scoped(async move { store.jobs().enqueue_within(&job("kcs"), 10).await }),
        )
    });
    let queued = join_all(requests).await.into_iter().map(Result::unwrap);
    let (queued, refused): (Vec<_>, Vec<_>) = queued.partition(Result::is_ok);
    assert_eq!(queued.len(), 10);
    for refusal in refused {
        assert!(matches!(refusal, Err(StoreError::QuotaExceeded { .. })), "{refusal:?}");
    }
    let other = Actor::new("bob", "::1");
    assert!(other.run_scoped(on.store.jobs().enqueue_within(&job("kcs"), 10)).await.is_ok());
}

async fn an_author_cancels_all_own_jobs_and_no_others(on: &TestStore) {
    let running = queue(on, "ann", job("kcs")).await.id;
    claim(on, "a").await.unwrap();
    let waiting = queue(on, "ann", job("pcc")).await.id;
    let foreign = queue(on, "bob", job("kcs")).await.id;
    let jobs = on.store.jobs();
    let ann = || Actor::new("ann", "::1");
    assert_eq!(ann().run_scoped(jobs.cancel_own(Some("pcc"))).await.unwrap().len(), 1);
    assert_eq!(ann().run_scoped(jobs.cancel_own(None)).await.unwrap().len(), 1);
    assert_eq!(jobs.get(&waiting).await.unwrap().state, JobState::Cancelled);
    let running = jobs.get(&running).await.unwrap();
    assert_eq!((running.state, running.cancel_requested), (JobState::Running, true));
    assert_eq!(jobs.get(&foreign).await.unwrap().state, JobState::Queued);
}

on_both_databases!(
    an_engineer_with_many_jobs_does_not_delay_others,
    authors_and_their_ships_take_turns,
    small_jobs_precede_large_ones_that_have_not_waited_long,
    a_quota_holds_for_requests_at_once,
    an_author_cancels_all_own_jobs_and_no_others
);
