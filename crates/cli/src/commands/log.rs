//! The log of the commands that run until they are told to stop, on standard error.

use std::io::IsTerminal as _;

use clap::Args;
use tracing_subscriber::EnvFilter;

use super::config_file::ConfigFile;
use super::log_format::LogFormat;
use crate::failure::Failure;

/// What is logged, and how.
#[derive(Debug, Args)]
pub struct LogArguments {
    /// What is logged on standard error: a level, or levels by module (`info,sqlx=debug`).
    #[arg(long, value_name = "FILTER", env = "SISTERSHIP_LOG")]
    log: Option<String>,
    /// How it is written.
    #[arg(long, value_name = "FORMAT", env = "SISTERSHIP_LOG_FORMAT", value_enum)]
    log_format: Option<LogFormat>,
}

impl LogArguments {
    /// Begins to log.
    ///
    /// # Errors
    /// The filter does not read.
    pub fn begin(&self, file: &ConfigFile) -> Result<(), Failure> {
        let filter = self.log.as_deref().or(file.log.as_deref()).unwrap_or("info");
        let filter = EnvFilter::try_new(filter)
            .map_err(|error| Failure::Call(format!("log filter `{filter}`: {error}")))?;
        let log = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr);
        match self.log_format.or(file.log_format).unwrap_or_default() {
            LogFormat::Text => log.with_ansi(std::io::stderr().is_terminal()).init(),
            LogFormat::Json => log.json().flatten_event(true).init(),
        }
        Ok(())
    }
}
