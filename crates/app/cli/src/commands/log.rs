//! Log of the commands that run until they are stopped, on standard error.

use std::io::IsTerminal as _;

use clap::Args;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;

use super::config_file::ConfigFile;
use super::log_format::LogFormat;
use crate::failure::Failure;

/// Arguments of the log.
#[derive(Debug, Args)]
pub struct LogArguments {
    /// Filter of the log on standard error: a level, or levels by module (`info,sqlx=debug`).
    #[arg(long, value_name = "FILTER", env = "SISTERSHIP_LOG")]
    log: Option<String>,
    /// Format of the log.
    #[arg(long, value_name = "FORMAT", env = "SISTERSHIP_LOG_FORMAT", value_enum)]
    log_format: Option<LogFormat>,
}

impl LogArguments {
    /// Starts the log.
    ///
    /// # Errors
    /// Returns an error if the filter cannot be parsed.
    pub fn start_log(&self, file: &ConfigFile) -> Result<(), Failure> {
        // The flag and its environment variable have precedence over the file.
        let filter = self.log.as_deref().or(file.log.as_deref()).unwrap_or("info");
        let filter: Targets = filter
            .parse()
            .map_err(|error| Failure::Call(format!("log filter `{filter}`: {error}")))?;
        let registry = tracing_subscriber::registry().with(filter);
        let lines = tracing_subscriber::fmt::layer().with_writer(std::io::stderr);
        match self.log_format.or(file.log_format).unwrap_or_default() {
            LogFormat::Text => {
                registry.with(lines.with_ansi(std::io::stderr().is_terminal())).init();
            }
            LogFormat::Json => registry.with(lines.json().flatten_event(true)).init(),
        }
        Ok(())
    }
}
