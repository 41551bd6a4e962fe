//! Log and traces of the commands that run until they are stopped; the log is on standard error.

use std::io::IsTerminal as _;

use clap::Args;
use tracing_subscriber::Layer as _;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;

use super::config_file::ConfigFile;
use super::log_format::LogFormat;
use super::traces::TraceExport;
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
    /// Collector of OpenTelemetry that gets traces of requests and jobs by OTLP over HTTP, such as
    /// http://127.0.0.1:4318 [default: none].
    #[arg(long, value_name = "URL", env = "SISTERSHIP_OTLP_ENDPOINT")]
    otlp_endpoint: Option<String>,
}

/// Beginning of the names of the modules whose spans are exported.
const TRACED: &str = "sistership";

impl LogArguments {
    /// Starts the log, and the export of traces if a collector is named, until it is dropped.
    ///
    /// # Errors
    /// Returns an error if the filter or the URL of the collector cannot be parsed.
    pub fn start_log(&self, file: &ConfigFile) -> Result<Option<TraceExport>, Failure> {
        // The flag and its environment variable have precedence over the file.
        let filter = self.log.as_deref().or(file.log.as_deref()).unwrap_or("info");
        let filter: Targets = filter
            .parse()
            .map_err(|error| Failure::Call(format!("log filter `{filter}`: {error}")))?;
        let endpoint = self.otlp_endpoint.as_deref().or(file.otlp_endpoint.as_deref());
        let export = endpoint.map(TraceExport::start).transpose()?;
        // The filter of the log does not hold for traces.
        let spans = export.as_ref().map(|export| {
            let traced = Targets::new().with_target(TRACED, LevelFilter::INFO);
            tracing_opentelemetry::layer().with_tracer(export.tracer()).with_filter(traced)
        });
        let lines = tracing_subscriber::fmt::layer().with_writer(std::io::stderr);
        let lines = match self.log_format.or(file.log_format).unwrap_or_default() {
            LogFormat::Text => lines.with_ansi(std::io::stderr().is_terminal()).boxed(),
            LogFormat::Json => lines.json().flatten_event(true).boxed(),
        };
        tracing_subscriber::registry().with(lines.with_filter(filter)).with(spans).init();
        Ok(export)
    }
}
