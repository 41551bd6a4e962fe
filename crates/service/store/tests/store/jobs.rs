use std::time::Duration;

use sistership_store::{
    Job, JobClaim, JobFilter, JobState, MAX_LOST_WORKERS, PageRequest, QueueWatch, WorkerClaim,
};

use crate::support::*;

pub const LEASE: Duration = Duration::from_secs(30);

/// The claim of a worker whose process does nothing else.
pub fn any_job(worker: &str) -> WorkerClaim<'_> {
    WorkerClaim { worker, lease: LEASE, alone: true, small: false }
}

pub async fn claim(on: &TestStore, worker: &str) -> Option<Job> {
    match on.store.jobs().claim_next(&any_job(worker)).await.unwrap() {
        JobClaim::Job(job) => Some(*job),
        JobClaim::Alone => panic!("a process that does nothing else may claim any job"),
        JobClaim::Nothing => None,
    }
}

pub async fn let_the_lease_run_out(on: &TestStore) {
    on.clock.advance(LEASE + Duration::from_micros(1));
}

async fn a_job_runs_and_ends(on: &TestStore) {
    let jobs = on.store.jobs();
    assert_eq!(claim(on, "a").await, None);
    let first = jobs.enqueue(&job("kcs")).await.unwrap();
    let second = jobs.enqueue(&job("pcc")).await.unwrap();
    assert_eq!(first.state, JobState::Queued);
    let running = claim(on, "a").await.unwrap();
    assert_eq!(
        (&running.id, running.state, running.attempt, running.fence),
        (&first.id, JobState::Running, 1, 1)
    );
    assert_eq!(claim(on, "b").await.unwrap().id, second.id);
    assert_eq!(claim(on, "c").await, None);
    assert!(!jobs.heartbeat(&first.id, 1, 0.5, "half way", LEASE).await.unwrap());
    assert_eq!(jobs.get(&first.id).await.unwrap().progress, 0.5);
    let done = jobs.complete(&first.id, 1, r#"{"version":3}"#).await.unwrap();
    assert_eq!((done.state, done.progress, done.lease_until_us), (JobState::Succeeded, 1.0, None));
    assert_conflict(jobs.complete(&first.id, 1, "{}").await, "succeeded");
    assert_not_found(jobs.get("none").await, "job");
    assert_not_found(jobs.heartbeat("none", 1, 0.0, "", LEASE).await, "job");
}

/// Returns true if jobs have been queued since the last call.
async fn is_woken(watch: &mut QueueWatch) -> bool {
    tokio::time::timeout(Duration::from_millis(20), watch.wait_queued()).await.is_ok()
}

async fn whatever_queues_a_job_wakes_the_workers_once_it_is_there(on: &TestStore) {
    let jobs = on.store.jobs();
    let mut watch = jobs.watch_queue();
    assert!(!is_woken(&mut watch).await, "nothing is queued");
    let id = jobs.enqueue(&job("kcs")).await.unwrap().id;
    assert!(is_woken(&mut watch).await, "also if it was queued before the worker waits");
    let fence = claim(on, "a").await.unwrap().fence;
    jobs.fail(&id, fence, "no").await.unwrap();
    assert!(!is_woken(&mut watch).await, "nothing more is queued");
    jobs.retry(&id).await.unwrap();
    assert!(is_woken(&mut watch).await, "queued again");
    jobs.request_cancel(&id).await.unwrap();
    let unit = on.store.begin_unit();
    unit.store().jobs().enqueue(&job("kcs")).await.unwrap();
    assert!(!is_woken(&mut watch).await, "not committed yet");
    unit.commit(None).await.unwrap();
    assert!(is_woken(&mut watch).await, "committed with its unit of work");
    let mut other = jobs.watch_queue();
    on.store.ships().create(&ship("kcs")).await.unwrap();
    assert!(!is_woken(&mut watch).await, "a ship is no job");
    let (trials, objects) = (on.store.trials(), sistership_store::ObjectStorage::in_memory());
    trials.insert_all_and_enqueue(&[], &objects, |_| Some(job("kcs"))).await.unwrap();
    assert!(is_woken(&mut watch).await && is_woken(&mut other).await, "every worker");
}

async fn a_lost_lease_fences_the_old_worker(on: &TestStore) {
    let jobs = on.store.jobs();
    let id = jobs.enqueue(&job("kcs")).await.unwrap().id;
    let old = claim(on, "old").await.unwrap();
    on.clock.advance(LEASE);
    assert_eq!(claim(on, "new").await, None);
    jobs.heartbeat(&id, old.fence, 0.1, "", LEASE).await.unwrap();
    let_the_lease_run_out(on).await;
    let new = claim(on, "new").await.unwrap();
    assert_eq!((new.id.as_str(), new.fence, new.attempt), (id.as_str(), 2, 2));
    assert_conflict(jobs.heartbeat(&id, old.fence, 0.9, "", LEASE).await, "no longer valid");
    assert_conflict(jobs.complete(&id, old.fence, "{}").await, "no longer valid");
    assert_conflict(jobs.fail(&id, old.fence, "late").await, "no longer valid");
    assert_conflict(jobs.release_job(&id, old.fence).await, "no longer valid");
    assert_eq!(jobs.get(&id).await.unwrap(), new);
}

async fn a_job_that_ends_its_process_twice_is_set_aside(on: &TestStore) {
    let jobs = on.store.jobs();
    let poison = jobs.enqueue(&job("kcs")).await.unwrap().id;
    let healthy = jobs.enqueue(&job("pcc")).await.unwrap().id;
    for _ in 0..MAX_LOST_WORKERS {
        assert_eq!(claim(on, "mortal").await.unwrap().id, poison);
        let_the_lease_run_out(on).await;
    }
    assert_eq!(claim(on, "mortal").await.unwrap().id, healthy);
    let failed = jobs.get(&poison).await.unwrap();
    assert_eq!((failed.state, failed.attempt, failed.lost_workers), (JobState::Failed, 2, 2));
    let error = failed.error.unwrap();
    assert!(
        error.contains("the process of the job ended twice")
            && error.contains("not restarted automatically"),
        "{error}"
    );
    assert!(failed.finished_us.is_some());
    let again = jobs.retry(&poison).await.unwrap();
    assert_eq!((again.state, again.lost_workers), (JobState::Queued, 0));
    assert_eq!(claim(on, "mortal").await.unwrap().id, poison);
}

async fn a_job_during_which_a_process_ended_is_begun_alone(on: &TestStore) {
    let jobs = on.store.jobs();
    let suspect = jobs.enqueue(&job("kcs")).await.unwrap().id;
    claim(on, "mortal").await.unwrap();
    let_the_lease_run_out(on).await;
    assert_eq!(
        jobs.claim_next(&WorkerClaim { alone: false, ..any_job("busy") }).await.unwrap(),
        JobClaim::Alone
    );
    assert_eq!(claim(on, "idle").await.unwrap().id, suspect);
}

async fn only_the_end_of_a_process_counts(on: &TestStore) {
    let jobs = on.store.jobs();
    let id = jobs.enqueue(&job("kcs")).await.unwrap().id;
    for _ in 0..5 {
        let fence = claim(on, "drained").await.unwrap().fence;
        jobs.release_job(&id, fence).await.unwrap();
    }
    for _ in 0..5 {
        let late = claim(on, "late").await.unwrap();
        // As where the database was away: the lease runs out, another takes the job, and the first
        // comes back.
        let_the_lease_run_out(on).await;
        let fence = claim(on, "other").await.unwrap().fence;
        assert_eq!(jobs.get(&id).await.unwrap().lost_workers, 1);
        jobs.mark_alive(&id, late.fence).await.unwrap();
        assert_eq!(jobs.get(&id).await.unwrap().lost_workers, 0);
        jobs.mark_alive(&id, fence).await.unwrap();
        jobs.release_job(&id, fence).await.unwrap();
    }
    assert_eq!(claim(on, "last").await.unwrap().lost_workers, 0);
}

async fn a_job_is_cancelled(on: &TestStore) {
    let jobs = on.store.jobs();
    let waiting = jobs.enqueue(&job("kcs")).await.unwrap().id;
    assert_eq!(jobs.request_cancel(&waiting).await.unwrap().state, JobState::Cancelled);
    assert_eq!(claim(on, "a").await, None);
    let running = jobs.enqueue(&job("kcs")).await.unwrap().id;
    let fence = claim(on, "a").await.unwrap().fence;
    assert_eq!(jobs.request_cancel(&running).await.unwrap().state, JobState::Running);
    assert!(jobs.heartbeat(&running, fence, 0.5, "", LEASE).await.unwrap());
    let cancelled = jobs.end_cancelled(&running, fence).await.unwrap();
    assert_eq!((cancelled.state, cancelled.progress), (JobState::Cancelled, 0.5));
    assert_conflict(jobs.request_cancel(&running).await, "cancelled");
    assert_not_found(jobs.request_cancel("none").await, "job");
}

async fn a_dead_worker_cannot_keep_a_cancelled_job(on: &TestStore) {
    let id = on.store.jobs().enqueue(&job("kcs")).await.unwrap().id;
    claim(on, "a").await.unwrap();
    on.store.jobs().request_cancel(&id).await.unwrap();
    let_the_lease_run_out(on).await;
    assert_eq!(claim(on, "b").await, None);
    assert_eq!(on.store.jobs().get(&id).await.unwrap().state, JobState::Cancelled);
}

async fn a_failed_job_is_tried_again(on: &TestStore) {
    let jobs = on.store.jobs();
    let id = jobs.enqueue(&job("kcs")).await.unwrap().id;
    let fence = claim(on, "a").await.unwrap().fence;
    assert_conflict(jobs.retry(&id).await, "running");
    assert_eq!(
        jobs.fail(&id, fence, "the trials hold no turn").await.unwrap().error.unwrap(),
        "the trials hold no turn"
    );
    let queued = jobs.retry(&id).await.unwrap();
    assert_eq!(
        (queued.state, queued.error, queued.attempt, queued.fence),
        (JobState::Queued, None, 0, 1)
    );
    assert_eq!(claim(on, "b").await.unwrap().fence, 2);
}

async fn a_leaving_worker_gives_its_job_back(on: &TestStore) {
    let id = on.store.jobs().enqueue(&job("kcs")).await.unwrap().id;
    let fence = claim(on, "a").await.unwrap().fence;
    assert_eq!(on.store.jobs().release_job(&id, fence).await.unwrap().state, JobState::Queued);
    let again = claim(on, "b").await.unwrap();
    assert_eq!((again.attempt, again.fence), (1, 2));
}

async fn jobs_are_listed(on: &TestStore) {
    for ship in ["kcs", "kcs", "pcc", "kcs"] {
        on.store.jobs().enqueue(&job(ship)).await.unwrap();
    }
    let oldest = claim(on, "a").await.unwrap();
    let filter = JobFilter { ship: Some("kcs".into()), state: None };
    let first = on.store.jobs().list(&filter, &PageRequest::first_page(2)).await.unwrap();
    let second = on
        .store
        .jobs()
        .list(&filter, &PageRequest::after_key(first.next.unwrap(), 2))
        .await
        .unwrap();
    assert_eq!((first.items.len(), second.items, second.next), (2, vec![oldest.clone()], None));
    let running = JobFilter { ship: None, state: Some(JobState::Running) };
    assert_eq!(
        on.store.jobs().list(&running, &PageRequest::first_page(9)).await.unwrap().items,
        [oldest]
    );
    assert_eq!(
        on.store
            .jobs()
            .list(&JobFilter::default(), &PageRequest::first_page(9))
            .await
            .unwrap()
            .items
            .len(),
        4
    );
}

on_both_databases!(
    whatever_queues_a_job_wakes_the_workers_once_it_is_there,
    a_job_runs_and_ends,
    a_lost_lease_fences_the_old_worker,
    a_job_that_ends_its_process_twice_is_set_aside,
    a_job_during_which_a_process_ended_is_begun_alone,
    only_the_end_of_a_process_counts,
    a_job_is_cancelled,
    a_dead_worker_cannot_keep_a_cancelled_job,
    a_failed_job_is_tried_again,
    a_leaving_worker_gives_its_job_back,
    jobs_are_listed
);
