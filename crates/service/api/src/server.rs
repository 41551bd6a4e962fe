//! Start and stop of a server.

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

/// A running server, until it is [stopped](Self::stop) or dropped.
#[derive(Debug)]
pub struct RunningServer {
    addr: SocketAddr,
    process: Process,
}

impl Server {
    /// Opens the store, seeds the zoo, and starts to serve. Requests are answered as soon as this
    /// returns.
    ///
    /// # Errors
    /// Returns an error if the configuration is wrong, or if the address, the data folder or the
    /// store cannot be opened.
    pub async fn start(config: Config) -> Result<RunningServer, StartError> {
        config.check()?;
        sistership_store::provide_cryptography();
        // Bind the address first: a process that cannot have it must take no job from others.
        let limits = sistership_listener::fit_to_descriptors(config.limits.connection_limits());
        let listener = bind(config.listen)
            .map_err(|error| StartError::Listen { listen: config.listen, error })?;
        let addr = listener
            .local_addr()
            .map_err(|error| StartError::Listen { listen: config.listen, error })?;
        // `true`: only a server keeps the search index and delivers webhooks.
        let (mut process, app) = Process::start(&config, true).await?;
        let stopping = app.stop_signal();
        process.tasks.spawn(listen(listener, routes::router(app), limits, stopping));
        tracing::info!(%addr, "listening");
        Ok(RunningServer { addr, process })
    }
}

impl RunningServer {
    /// Address and port of the server.
    pub fn local_addr(&self) -> SocketAddr {
        self.addr
    }

    /// URL of its front page, without a slash at the end.
    pub fn url(&self) -> String {
        format!("http://{}", self.addr)
    }

    /// Database and samples of the server, for a program that embeds it.
    pub fn archive(&self) -> &Archive {
        &self.process.archive
    }

    /// Stops the server: it accepts no further connections, answers the requests in progress, and
    /// gives running jobs [`crate::Leases::drain`] to finish before they go back to the queue.
    pub async fn stop(self) {
        self.process.stop().await;
    }
}
