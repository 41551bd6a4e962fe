//! Workers without a server: any number of such processes share the jobs of one database.

use crate::config::Config;
use crate::process::Process;
use crate::start_error::StartError;
use sistership_jobs::archive::Archive;

/// Workers that run, until they are [stopped](Self::stop) or dropped.
#[derive(Debug)]
pub struct Workers(Process);

impl Workers {
    /// Opens the store, brings the zoo in, and works on the jobs that it finds, [`Config::workers`]
    /// at a time.
    ///
    /// # Errors
    /// Says what is wrong with the configuration, or what cannot be opened.
    pub async fn start(config: Config) -> Result<Self, StartError> {
        config.check()?;
        let (process, _) = Process::start(&config, false).await?;
        tracing::info!(workers = config.workers, "working");
        Ok(Self(process))
    }

    /// Their database and samples.
    pub fn archive(&self) -> &Archive {
        &self.0.archive
    }

    /// Stops: no further jobs, and those under way get [`crate::Leases::drain`] to end and then go
    /// back to the queue.
    pub async fn stop(self) {
        self.0.stop().await;
    }
}
