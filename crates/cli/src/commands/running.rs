//! What the commands that run until they are told to stop have in common: their log, their signals, their leases.

use std::io::IsTerminal as _;
use std::time::Duration;

use clap::Args;
use sistership_server::Leases;
use tracing_subscriber::EnvFilter;

use crate::failure::Failure;
use crate::output;

/// Holds the filter of the log.
const LOG: &str = "SISTERSHIP_LOG";

/// How workers hold their jobs.
#[derive(Debug, Args)]
pub struct LeaseArguments {
    /// Seconds without a sign of life after which a job goes to another worker, 0.5 to 3600.
    #[arg(long, value_name = "SECONDS", env = "SISTERSHIP_LEASE_S", default_value = "15", value_parser = lease)]
    lease_s: Duration,
}

impl LeaseArguments {
    /// The leases that they ask for.
    pub fn leases(&self) -> Leases {
        Leases::of(self.lease_s)
    }
}

fn lease(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| format!("`{text}` is not a number of seconds"))?;
    match (0.5..=Leases::MAX.as_secs_f64()).contains(&seconds) {
        true => Ok(Duration::from_secs_f64(seconds)),
        false => Err(format!("must be from 0.5 to {} s, not {seconds}", Leases::MAX.as_secs())),
    }
}

/// Logs on standard error, as much as `SISTERSHIP_LOG` asks for.
pub fn log() {
    let filter = EnvFilter::try_from_env(LOG).unwrap_or_else(|_| EnvFilter::new("info"));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .init();
}

/// Waits for a signal, then for what `stop` waits for; a second signal does not wait.
///
/// # Errors
/// Signals cannot be heard, or a second one came.
pub async fn until_stopped(stop: impl Future<Output = ()>) -> Result<(), Failure> {
    signal().await?;
    output::note("stopping; once more to stop at once");
    tokio::select! {
        () = stop => Ok(()),
        second = signal() => second.and(Err(Failure::Refused("stopped before everything under way had ended".into()))),
    }
}

/// Ctrl-C, or SIGTERM where there is one.
async fn signal() -> Result<(), Failure> {
    let unheard = |error: std::io::Error| Failure::Refused(format!("signals cannot be heard: {error}"));
    #[cfg(unix)]
    {
        let mut terminate = tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate()).map_err(unheard)?;
        tokio::select! {
            interrupted = tokio::signal::ctrl_c() => interrupted.map_err(unheard),
            _ = terminate.recv() => Ok(()),
        }
    }
    #[cfg(not(unix))]
    tokio::signal::ctrl_c().await.map_err(unheard)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leases_are_read_or_refused_with_their_bounds() {
        assert_eq!(lease("1.5"), Ok(Duration::from_millis(1500)));
        for wrong in ["0.1", "3601", "NaN", "-1", "soon"] {
            assert!(lease(wrong).is_err_and(|why| why.contains("seconds") || why.contains("0.5 to 3600")), "{wrong}");
        }
    }
}
