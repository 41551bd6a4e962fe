//! A batch of jobs, four worker processes on one database, and one of them killed now and then
//! in the middle of a job.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use serde_json::Value;
use sistership_store::testing::TestDatabase;
use sistership_store::{Job, JobFilter, JobState, PageRequest, Store, SystemClock};
use sistership_tests::binary;
use sistership_tests::server::TestServer;
use sistership_tests::worker::TestWorker;

use super::over_http::{create, refine_weakly, upload_few, verified};
use super::sea_trials::NAME;

const JOBS: usize = 6;
const WORKERS: usize = 4;
const KILLED: usize = 3;
// Long enough that a busy machine makes no heartbeat late: a job that loses one worker by that and
// one by the test would be failed as the cause of both.
const LEASE_S: &str = "8";
const BETWEEN: Duration = Duration::from_millis(300);
const PATIENCE: Duration = Duration::from_secs(300);

/// The workers, and the store as an onlooker sees it.
struct Fleet {
    server: TestServer,
    workers: Vec<TestWorker>,
    store: Store,
    begun: Instant,
}

impl Fleet {
    async fn on(database: TestDatabase) -> Self {
        let server = TestServer::on(database, &["--no-worker"]).await;
        let store =
            Store::connect(&server.database().url, Arc::new(SystemClock)).await.expect("a store");
        Self { server, workers: Vec::new(), store, begun: Instant::now() }
    }

    async fn jobs(&self) -> Vec<Job> {
        self.store
            .jobs()
            .list(&JobFilter::default(), &PageRequest::first_page(1000))
            .await
            .expect("the jobs")
            .items
    }

    fn hire(&mut self) {
        self.workers.push(TestWorker::start(&self.server, LEASE_S));
    }

    /// Kills a worker that holds a job which has not lost one yet (two losses would be the job's
    /// own fault). It is halted first, so that what it holds is what it loses.
    async fn kill_one(&mut self) {
        loop {
            assert!(
                self.begun.elapsed() < PATIENCE,
                "no job is running that could lose its worker"
            );
            for place in 0..self.workers.len() {
                self.workers[place].halt();
                if self.first_loss(self.workers[place].id()).await {
                    self.workers.swap_remove(place).kill();
                    return self.hire();
                }
                // It held nothing, or what it must not lose once more.
                self.workers[place].resume();
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
    }

    /// True if a worker holds a job, and none that has lost another worker.
    async fn first_loss(&self, worker: u32) -> bool {
        let name = format!("{worker}-");
        let jobs = self.jobs().await;
        let mut held = jobs.iter().filter(|job| {
            job.state == JobState::Running
                && job.worker.as_ref().is_some_and(|holder| holder.starts_with(&name))
        });
        held.next().is_some_and(|job| job.attempt == 1) && held.all(|job| job.attempt == 1)
    }

    async fn until_done(&self) -> Vec<Job> {
        loop {
            let jobs = self.jobs().await;
            if jobs.iter().all(|job| job.state.is_final()) {
                return jobs;
            }
            assert!(self.begun.elapsed() < PATIENCE, "the batch does not end: {jobs:#?}");
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
    }
}

async fn every_job_is_done_once(database: TestDatabase) {
    let mut fleet = Fleet::on(database).await;
    create(&fleet.server).await;
    upload_few(&fleet.server).await;
    for number in 0..JOBS {
        refine_weakly(&fleet.server, &format!("job-{number}")).await;
    }
    assert!(
        fleet.jobs().await.iter().all(|job| job.state == JobState::Queued),
        "a server without workers takes no job"
    );
    (0..WORKERS).for_each(|_| fleet.hire());
    for _ in 0..KILLED {
        fleet.kill_one().await;
        tokio::time::sleep(BETWEEN).await;
    }
    let jobs = fleet.until_done().await;
    assert_eq!(
        jobs.iter().filter(|job| job.state == JobState::Succeeded).count(),
        JOBS,
        "{jobs:#?}"
    );
    let lost = jobs.iter().filter(|job| job.fence > 1).count();
    assert!(
        lost >= KILLED,
        "{KILLED} workers were killed, but only {lost} jobs have changed hands"
    );
    kept_once(&fleet, &jobs).await;
    verified(&fleet.server, JOBS as i64).await;
    let store = fleet.server.store_arguments();
    assert_eq!(
        binary::run(&["fsck", &store[0], &store[1], &store[2], &store[3]]).status.code(),
        Some(0)
    );
}

/// One version, one report and one move of an alias for each job, and none besides.
async fn kept_once(fleet: &Fleet, jobs: &[Job]) {
    let results =
        jobs.iter().filter_map(|job| serde_json::from_str::<Value>(job.result.as_deref()?).ok());
    let made: BTreeSet<i64> = results.filter_map(|result| result["version"].as_i64()).collect();
    let versions = fleet
        .store
        .versions()
        .list(NAME, &PageRequest::first_page(1000))
        .await
        .expect("the versions")
        .items;
    assert_eq!(
        made,
        (1..=JOBS as i64).collect(),
        "each job names a version of its own, without gaps"
    );
    assert_eq!(versions.len(), JOBS, "no version that no job names");
    for version in &versions {
        let reports = fleet
            .store
            .reports()
            .by_version(&version.id, &PageRequest::first_page(10))
            .await
            .expect("the reports")
            .items;
        assert_eq!(reports.len(), 1, "one report on version {}", version.number);
    }
    let moves = |alias: &'static str| async move {
        let moves =
            fleet.store.aliases().list_history(NAME, alias, &PageRequest::first_page(1000)).await;
        moves.expect("the history").items.len()
    };
    assert_eq!(
        (moves("champion").await, moves("candidate").await, moves("latest").await),
        (1, JOBS - 1, JOBS)
    );
}

#[tokio::test]
async fn four_workers_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        every_job_is_done_once(database).await;
    }
}

#[tokio::test]
async fn four_workers_on_sqlite() {
    every_job_is_done_once(TestDatabase::new_sqlite()).await;
}
