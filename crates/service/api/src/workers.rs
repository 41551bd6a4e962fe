//! Workers without a server: any number of such processes share the jobs of one database.

use crate::config::Config;
use crate::process::Process;
use crate::start_error::StartError;
use sistership_jobs::archive::Archive;

/// Running workers, until they are [stopped](Self::stop) or dropped.
#[derive(Debug)]
pub struct Workers(Process);

impl Workers {
    /// Opens the store, seeds the zoo, and works on queued jobs, [`Config::workers`] at a time.
    ///
    /// # Errors
    /// Returns an error if the configuration is wrong or the store cannot be opened.
    pub async fn start(config: Config) -> Result<Self, StartError> {
        config.check()?;
        let (process, _) = Process::start(&config, false).await?;
        tracing::info!(workers = config.workers, "working");
        Ok(Self(process))
    }

    /// Database and samples of the workers.
    pub fn archive(&self) -> &Archive {
        &self.0.archive
    }

    /// Stops the workers: they claim no further jobs, and give running jobs
    /// [`crate::Leases::drain`] to finish before they go back to the queue.
    pub async fn stop(self) {
        self.0.stop().await;
    }
}
