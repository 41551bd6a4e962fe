//! Parts that every process of Sistership has, whether it answers requests or only works on jobs:
//! the shared state, the workers, and the signal that stops them.

use std::time::Duration;

use tokio::sync::watch;
use tokio::task::JoinSet;

use crate::app::App;
use crate::config::Config;
use crate::jobs::{JobClass, Worker};
use crate::search_index;
use crate::start_error::StartError;
use crate::tidy;
use sistership_jobs::archive::Archive;
use sistership_jobs::catalogue::ZooCache;
use sistership_jobs::seed;
use sistership_jobs::webhooks::DeliverySettings;
use sistership_listener::StopSignal;

/// Time that the start waits for the maintenance.
const TIDY_TIME: Duration = Duration::from_secs(5);

/// A process that runs until it is [stopped](Self::stop) or dropped.
#[derive(Debug)]
pub(crate) struct Process {
    pub archive: Archive,
    pub tasks: JoinSet<()>,
    stop: watch::Sender<bool>,
    bound: Duration,
}

impl Process {
    /// Opens the store, seeds the zoo, and starts the workers; keeps the search index up to date
    /// and delivers webhooks if `indexes` is set.
    pub(crate) async fn start(config: &Config, indexes: bool) -> Result<(Self, App), StartError> {
        let archive = Archive::open_at(&config.database_url, &config.objects).await?;
        // Laws and ships of the zoo first: workers and handlers expect them in the store.
        let catalogue = ZooCache::default();
        seed::seed_zoo(&archive.store, &catalogue).await?;
        let (stop, stopping) = StopSignal::new();
        let app = App::new(config, archive.clone(), catalogue, stopping)?;
        // What does not answer in time is left to the next run: the server answers all that it can
        // without it.
        if tokio::time::timeout(TIDY_TIME, tidy::run_once(&app)).await.is_err() {
            tracing::warn!("the maintenance at the start did not end in time");
        }
        let mut tasks = JoinSet::new();
        tasks.spawn(tidy::run_loop(app.clone()));
        if indexes {
            tasks.spawn(search_index::run_loop(app.clone()));
            tasks.spawn(deliver_webhooks(app.clone()));
        }
        for _ in 0..config.workers {
            tasks.spawn(Worker::new(app.clone(), JobClass::Any).run());
        }
        // Small jobs have a worker that no large one can occupy.
        if config.workers > 0 {
            tasks.spawn(Worker::new(app.clone(), JobClass::Small).run());
        }
        Ok((Self { archive, tasks, stop, bound: config.stop_deadline() }, app))
    }

    /// Stops all tasks and waits for their end, but not longer than the configuration allows.
    pub(crate) async fn stop(mut self) {
        self.stop.send_replace(true);
        // The store is closed last, as the tasks write to it until they have ended.
        let ended = async {
            while self.tasks.join_next().await.is_some() {}
            self.archive.store.close().await;
        };
        if tokio::time::timeout(self.bound, ended).await.is_err() {
            tracing::warn!("some work was still in progress at the deadline");
        }
    }
}

/// Delivers events to webhooks until the server stops.
async fn deliver_webhooks(app: App) {
    let settings = DeliverySettings {
        private: app.limits().webhooks_private,
        poll: app.leases().poll,
        mail: app.mail().cloned(),
    };
    let mut stopping = app.stop_signal();
    tokio::select! {
        () = sistership_jobs::webhooks::run_deliveries(app.store().clone(), settings) => {}
        () = stopping.wait() => {}
    }
}
