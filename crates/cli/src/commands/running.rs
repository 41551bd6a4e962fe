//! What the commands that run until they are told to stop have in common: how they hold their jobs, and how they stop.

use std::time::Duration;

use clap::Args;
use sistership_server::Leases;

use super::config_file::ConfigFile;
use crate::failure::Failure;
use crate::output;

/// Jobs worked on at a time when nobody says otherwise, and at most.
const WORKERS: u16 = 1;
const MOST_WORKERS: u16 = 64;

/// Memory that requests or jobs may be given, MB.
const LEAST_MEMORY_MB: u64 = 32;
const MOST_MEMORY_MB: u64 = 1 << 20;

/// How workers hold their jobs.
#[derive(Debug, Args)]
pub struct LeaseArguments {
    /// Seconds without a sign of life after which a job goes to another worker, 0.5 to 3600 [default: 15].
    #[arg(long, value_name = "SECONDS", env = "SISTERSHIP_LEASE_S")]
    lease_s: Option<f64>,
    /// Seconds for which a job under way goes on when the process is told to stop, 0 to 86400 [default: 20].
    #[arg(long, value_name = "SECONDS", env = "SISTERSHIP_DRAIN_S")]
    drain_s: Option<f64>,
}

impl LeaseArguments {
    /// The leases that they and the file ask for.
    ///
    /// # Errors
    /// Names the setting that is out of bounds.
    pub fn leases(&self, file: &ConfigFile) -> Result<Leases, Failure> {
        let mut leases = Leases::default();
        if let Some(lease_s) = self.lease_s.or(file.lease_s) {
            leases = Leases::of(seconds("lease_s", lease_s, 0.5, Leases::MAX)?);
        }
        if let Some(drain_s) = self.drain_s.or(file.drain_s) {
            leases.drain = seconds("drain_s", drain_s, 0.0, Leases::MAX_DRAIN)?;
        }
        Ok(leases)
    }
}

fn seconds(name: &str, value: f64, least: f64, most: Duration) -> Result<Duration, Failure> {
    match (least..=most.as_secs_f64()).contains(&value) {
        true => Ok(Duration::from_secs_f64(value)),
        false => Err(Failure::Call(format!("{name} must be from {least} to {} s, not {value}", most.as_secs()))),
    }
}

/// Memory in MB, as the flag or the file asks for, in bytes.
///
/// # Errors
/// Names the setting that is out of bounds.
pub fn memory(name: &str, given: Option<u64>, file: Option<u64>, default: u64) -> Result<u64, Failure> {
    let Some(mb) = given.or(file) else { return Ok(default) };
    match (LEAST_MEMORY_MB..=MOST_MEMORY_MB).contains(&mb) {
        true => Ok(mb << 20),
        false => Err(Failure::Call(format!("{name} must be from {LEAST_MEMORY_MB} to {MOST_MEMORY_MB} MB, not {mb}"))),
    }
}

/// Jobs worked on at a time, as the flag or the file asks for.
///
/// # Errors
/// The number is out of bounds.
pub fn workers(given: Option<u16>, file: &ConfigFile, least: u16) -> Result<usize, Failure> {
    let workers = given.or(file.workers).unwrap_or(WORKERS);
    match (least..=MOST_WORKERS).contains(&workers) {
        true => Ok(usize::from(workers)),
        false => Err(Failure::Call(format!("workers must be from {least} to {MOST_WORKERS}, not {workers}"))),
    }
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
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn flags_come_before_the_file_and_the_file_before_the_default() {
        let file = ConfigFile { lease_s: Some(30.0), drain_s: Some(1.0), workers: Some(3), ..ConfigFile::default() };
        let leases = LeaseArguments { lease_s: Some(2.0), drain_s: None }.leases(&file).unwrap();
        assert_eq!((leases.lease.as_secs(), leases.drain.as_secs()), (2, 1));
        let none = LeaseArguments { lease_s: None, drain_s: None };
        assert_eq!(none.leases(&ConfigFile::default()).unwrap(), Leases::default());
        assert_eq!((workers(Some(5), &file, 1), workers(None, &file, 1)), (Ok(5), Ok(3)));
        assert_eq!(workers(None, &ConfigFile::default(), 1), Ok(1));
    }

    #[test]
    fn memory_is_given_in_megabytes() {
        assert_eq!(memory("job_memory_mb", None, Some(64), 7), Ok(64 << 20));
        assert_eq!(memory("job_memory_mb", Some(32), Some(64), 7), Ok(32 << 20));
        assert_eq!(memory("job_memory_mb", None, None, 7), Ok(7));
        let wrong = memory("job_memory_mb", Some(8), None, 7).unwrap_err();
        assert!(wrong.message().unwrap().contains("job_memory_mb must be from 32"));
    }

    #[test]
    fn what_is_out_of_bounds_is_named() {
        let lease = |lease_s| LeaseArguments { lease_s: Some(lease_s), drain_s: None }.leases(&ConfigFile::default());
        for wrong in [0.1, 3601.0, f64::NAN] {
            assert!(lease(wrong).is_err_and(|why| why.message().unwrap().contains("lease_s must be from 0.5 to 3600")));
        }
        let file = ConfigFile { drain_s: Some(-1.0), workers: Some(65), ..ConfigFile::default() };
        assert!(
            LeaseArguments { lease_s: None, drain_s: None }.leases(&file).unwrap_err().message().unwrap().contains("drain_s")
        );
        assert!(workers(None, &file, 0).is_err() && workers(Some(0), &file, 1).is_err());
    }
}
