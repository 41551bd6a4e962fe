//! Starting and stopping.

use std::net::SocketAddr;

use tokio::net::TcpListener;
use tokio::sync::watch;
use tokio::task::JoinSet;

use crate::app::{self, App};
use crate::archive::Archive;
use crate::catalogue::Catalogue;
use crate::config::Config;
use crate::jobs::Worker;
use crate::listen::listen;
use crate::start_error::StartError;
use crate::stopping::Stopping;
use crate::{routes, seed, upload};

/// The server of Sistership.
#[derive(Debug, Clone, Copy)]
pub struct Server;

/// A server that runs, until it is [stopped](Self::stop) or dropped.
#[derive(Debug)]
pub struct Running {
    addr: SocketAddr,
    archive: Archive,
    stop: watch::Sender<bool>,
    tasks: JoinSet<()>,
}

impl Server {
    /// Opens the store, brings the zoo in, and serves. It answers as soon as this returns.
    ///
    /// # Errors
    /// Says what is wrong with the configuration, or what cannot be opened.
    pub async fn start(config: Config) -> Result<Running, StartError> {
        config.check()?;
        spool(&config)?;
        let archive = Archive::open(&config.database_url, &config.data_dir).await?;
        let catalogue = Catalogue::default();
        seed::seed(&archive.store, &catalogue).await?;
        archive.store.idempotency().purge().await?;
        let listener = bind(config.listen).await?;
        let addr = listener.local_addr().map_err(|error| StartError::Listen { listen: config.listen, error })?;
        let (stop, stopping) = Stopping::new();
        let app = App::new(&config, archive.clone(), catalogue, stopping.clone());
        let mut tasks = JoinSet::new();
        for _ in 0..config.workers {
            tasks.spawn(Worker::new(app.clone()).run());
        }
        tasks.spawn(listen(listener, routes::router(app), config.limits, stopping));
        tracing::info!(%addr, "listening");
        Ok(Running { addr, archive, stop, tasks })
    }
}

impl Running {
    /// Where it listens.
    pub fn addr(&self) -> SocketAddr {
        self.addr
    }

    /// The URL of its front page, without a slash at the end.
    pub fn url(&self) -> String {
        format!("http://{}", self.addr)
    }

    /// Its database and samples, for a program that runs the server within itself.
    pub fn archive(&self) -> &Archive {
        &self.archive
    }

    /// Stops: no further connections, requests under way are answered, jobs under way go back to the queue.
    pub async fn stop(mut self) {
        self.stop.send_replace(true);
        while self.tasks.join_next().await.is_some() {}
        self.archive.store.close().await;
    }
}

async fn bind(listen: SocketAddr) -> Result<TcpListener, StartError> {
    TcpListener::bind(listen).await.map_err(|error| StartError::Listen { listen, error })
}

/// The folder of uploads, without those of a process that was killed long ago.
fn spool(config: &Config) -> Result<(), StartError> {
    let folder = app::spool(config);
    let cleared = std::fs::create_dir_all(&folder).and_then(|()| upload::clear(&folder));
    cleared.map_err(|error| StartError::Folder { folder, error })
}
