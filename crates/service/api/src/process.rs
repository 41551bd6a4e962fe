//! What a process of Sistership consists of, whether it answers requests or only works: the shared
//! state, its workers, and the word that stops them.

use std::time::Duration;

use tokio::sync::watch;
use tokio::task::JoinSet;

use crate::app::App;
use crate::config::Config;
use crate::jobs::Worker;
use crate::search_index;
use crate::start_error::StartError;
use crate::tidy;
use sistership_jobs::archive::Archive;
use sistership_jobs::catalogue::Catalogue;
use sistership_jobs::seed;
use sistership_jobs::webhooks::Telling;
use sistership_listener::Stopping;

/// A process that runs until it is [stopped](Self::stop) or dropped.
#[derive(Debug)]
pub(crate) struct Process {
    pub archive: Archive,
    pub tasks: JoinSet<()>,
    stop: watch::Sender<bool>,
    bound: Duration,
}

impl Process {
    /// Opens the store, brings the zoo in, and sets the workers to work; keeps up what ships are
    /// found by, if it `indexes`.
    pub(crate) async fn start(config: &Config, indexes: bool) -> Result<(Self, App), StartError> {
        let archive = Archive::open_at(&config.database_url, &config.objects).await?;
        let catalogue = Catalogue::default();
        seed::seed(&archive.store, &catalogue).await?;
        let (stop, stopping) = Stopping::new();
        let app = App::new(config, archive.clone(), catalogue, stopping)?;
        tidy::once(&app).await;
        let mut tasks = JoinSet::new();
        tasks.spawn(tidy::keep(app.clone()));
        if indexes {
            tasks.spawn(search_index::keep(app.clone()));
            tasks.spawn(told(app.clone()));
        }
        for _ in 0..config.workers {
            tasks.spawn(Worker::new(app.clone()).run());
        }
        Ok((Self { archive, tasks, stop, bound: config.stop_bound() }, app))
    }

    /// Stops what runs, and waits for its end, but not longer than [`Config::stop_bound`].
    pub(crate) async fn stop(mut self) {
        self.stop.send_replace(true);
        let ended = async {
            while self.tasks.join_next().await.is_some() {}
            self.archive.store.close().await;
        };
        if tokio::time::timeout(self.bound, ended).await.is_err() {
            tracing::warn!("not everything under way has ended in time");
        }
    }
}

/// Tells webhooks what has happened, until the server is told to stop.
async fn told(app: App) {
    let telling = Telling { private: app.limits().webhooks_private, poll: app.leases().poll };
    let mut stopping = app.stopping();
    tokio::select! {
        () = sistership_jobs::webhooks::keep(app.store().clone(), telling) => {}
        () = stopping.wait() => {}
    }
}
