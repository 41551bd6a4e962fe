//! Starting and stopping.

use std::net::SocketAddr;

use crate::config::Config;
use crate::process::Process;
use crate::routes;
use crate::start_error::StartError;
use sistership_jobs::archive::Archive;
use sistership_listener::{bind, listen};

/// The server of Sistership.
#[derive(Debug, Clone, Copy)]
pub struct Server;

/// A server that runs, until it is [stopped](Self::stop) or dropped.
#[derive(Debug)]
pub struct Running {
    addr: SocketAddr,
    process: Process,
}

impl Server {
    /// Opens the store, brings the zoo in, and serves. It answers as soon as this returns.
    ///
    /// # Errors
    /// Says what is wrong with the configuration, or what cannot be opened.
    pub async fn start(config: Config) -> Result<Running, StartError> {
        config.check()?;
        sistership_store::provide_cryptography();
        // The address first: a process that cannot have it takes no job from others.
        let limits = sistership_listener::suited(config.limits.of_connections());
        let listener = bind(config.listen)
            .map_err(|error| StartError::Listen { listen: config.listen, error })?;
        let addr = listener
            .local_addr()
            .map_err(|error| StartError::Listen { listen: config.listen, error })?;
        let (mut process, app) = Process::start(&config, true).await?;
        let stopping = app.stopping();
        process.tasks.spawn(listen(listener, routes::router(app), limits, stopping));
        tracing::info!(%addr, "listening");
        Ok(Running { addr, process })
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
        &self.process.archive
    }

    /// Stops: no further connections, requests under way are answered, jobs under way get
    /// [`crate::Leases::drain`] to end and then go back to the queue.
    pub async fn stop(self) {
        self.process.stop().await;
    }
}
