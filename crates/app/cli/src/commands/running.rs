//! Common parts of the commands that run until they are stopped: limits of workers and memory,
//! leases, and the stop by a signal.

use std::time::Duration;

use clap::Args;
use sistership_api::LeaseSettings;
use tokio::sync::oneshot;

use super::config_file::ConfigFile;
use super::store::new_runtime;
use crate::failure::Failure;
use crate::output;

/// Default and largest number of concurrent jobs.
const WORKERS: u16 = 1;
const MOST_WORKERS: u16 = 64;

/// Limits of the memory of requests or jobs, MB.
const LEAST_MEMORY_MB: u64 = 32;
const MOST_MEMORY_MB: u64 = 1 << 20;

/// Arguments of the leases of workers on jobs.
#[derive(Debug, Args)]
pub struct LeaseArguments {
    /// Seconds without renewal of a lease after which a job passes to another worker, 0.5 to 3600
    /// [default: 15].
    #[arg(long, value_name = "SECONDS", env = "SISTERSHIP_LEASE_S")]
    lease_s: Option<f64>,
    /// Seconds that running jobs are given to finish when the process is stopped, 0 to 86400
    /// [default: 20].
    #[arg(long, value_name = "SECONDS", env = "SISTERSHIP_DRAIN_S")]
    drain_s: Option<f64>,
}

impl LeaseArguments {
    /// Returns the leases of the flags and the file.
    ///
    /// # Errors
    /// Returns an error that names the setting out of range.
    pub fn lease_settings(&self, file: &ConfigFile) -> Result<LeaseSettings, Failure> {
        let mut leases = LeaseSettings::default();
        if let Some(lease_s) = self.lease_s.or(file.lease_s) {
            leases = LeaseSettings::with_lease(parse_seconds(
                "lease_s",
                lease_s,
                0.5,
                LeaseSettings::MAX,
            )?);
        }
        if let Some(drain_s) = self.drain_s.or(file.drain_s) {
            leases.drain = parse_seconds("drain_s", drain_s, 0.0, LeaseSettings::MAX_DRAIN)?;
        }
        Ok(leases)
    }
}

fn parse_seconds(name: &str, value: f64, least: f64, most: Duration) -> Result<Duration, Failure> {
    match (least..=most.as_secs_f64()).contains(&value) {
        true => Ok(Duration::from_secs_f64(value)),
        false => Err(Failure::Call(format!(
            "{name} must be from {least} to {} s, not {value}",
            most.as_secs()
        ))),
    }
}

/// Returns the memory of the flag (MB), the file (MB) or the default (bytes), in bytes.
///
/// # Errors
/// Returns an error that names the setting out of range.
pub fn memory_bytes(
    name: &str,
    given: Option<u64>,
    file: Option<u64>,
    default: u64,
) -> Result<u64, Failure> {
    let Some(mb) = given.or(file) else { return Ok(default) };
    match (LEAST_MEMORY_MB..=MOST_MEMORY_MB).contains(&mb) {
        true => Ok(mb << 20),
        false => Err(Failure::Call(format!(
            "{name} must be from {LEAST_MEMORY_MB} to {MOST_MEMORY_MB} MB, not {mb}"
        ))),
    }
}

/// Returns the number of concurrent jobs of the flag, the file or the default.
///
/// # Errors
/// Returns an error if the number is out of range.
pub fn worker_count(given: Option<u16>, file: &ConfigFile, least: u16) -> Result<usize, Failure> {
    let workers = given.or(file.workers).unwrap_or(WORKERS);
    match (least..=MOST_WORKERS).contains(&workers) {
        true => Ok(usize::from(workers)),
        false => Err(Failure::Call(format!(
            "workers must be from {least} to {MOST_WORKERS}, not {workers}"
        ))),
    }
}

/// Runs `start` until a signal arrives, then `stop`; ends within `bound` after the signal.
///
/// Signals are received on a separate thread, which ends the process (exit status 1) when `bound`
/// has passed or a second signal arrives, even if all other threads are blocked. Computations that
/// nothing waits for any more end with the process.
///
/// # Errors
/// Returns the error of `start`, or an error if signals cannot be received.
pub fn run_until_stopped<T>(
    bound: Duration,
    start: impl Future<Output = Result<T, Failure>>,
    stop: impl AsyncFnOnce(T),
) -> Result<(), Failure> {
    let runtime = new_runtime()?;
    let told = watch_signals(bound)?;
    let ended = runtime.block_on(async {
        let unheard = || Failure::Refused("stop signals cannot be received".into());
        let mut told = told;
        // A signal during the start must end the command, too.
        let running = tokio::select! {
            running = start => running?,
            told = &mut told => return told.map_err(|_| unheard()),
        };
        told.await.map_err(|_| unheard())?;
        stop(running).await;
        Ok(())
    });
    // Blocking threads may compute for minutes; the end of the process must not wait for them.
    runtime.shutdown_background();
    ended
}

/// Starts to receive signals on a separate thread; the receiver gets the first one.
fn watch_signals(bound: Duration) -> Result<oneshot::Receiver<()>, Failure> {
    let (tell, told) = oneshot::channel();
    let none = |error| Failure::Refused(format!("threads cannot be started: {error}"));
    let runtime =
        // A runtime of its own: the main one may have no free thread when a signal arrives.
        tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(none)?;
    let mut signals = runtime.block_on(async { StopSignals::install_handler() })?;
    let heard = move || {
        runtime.block_on(async {
            signals.next().await;
            // The receiver is gone if the start has failed meanwhile; the process is ending then.
            tell.send(()).ok();
            output::print_note(
                "stopping after the work in progress; repeat the signal to stop at \
                                once",
            );
            if tokio::time::timeout(bound, signals.next()).await.is_err() {
                output::print_note(&format!(
                    "stopped after {} s with work still in progress",
                    bound.as_secs()
                ));
            }
            std::process::exit(i32::from(Failure::Told.exit_status()));
        });
    };
    std::thread::Builder::new().name("signals".into()).spawn(heard).map_err(none)?;
    Ok(told)
}

/// Signals that stop the process: Ctrl-C, and SIGTERM on Unix.
struct StopSignals {
    #[cfg(unix)]
    interrupt: tokio::signal::unix::Signal,
    #[cfg(unix)]
    terminate: tokio::signal::unix::Signal,
}

impl StopSignals {
    #[cfg(unix)]
    fn install_handler() -> Result<Self, Failure> {
        use tokio::signal::unix::{SignalKind, signal};
        let unheard = |error| Failure::Refused(format!("stop signals cannot be received: {error}"));
        let interrupt = signal(SignalKind::interrupt()).map_err(unheard)?;
        Ok(Self { interrupt, terminate: signal(SignalKind::terminate()).map_err(unheard)? })
    }

    #[cfg(not(unix))]
    fn hear() -> Result<Self, Failure> {
        Ok(Self {})
    }

    async fn next(&mut self) {
        #[cfg(unix)]
        tokio::select! {
            _ = self.interrupt.recv() => {}
            _ = self.terminate.recv() => {}
        }
        #[cfg(not(unix))]
        drop(tokio::signal::ctrl_c().await);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn flags_come_before_the_file_and_the_file_before_the_default() {
        let file = ConfigFile {
            lease_s: Some(30.0),
            drain_s: Some(1.0),
            workers: Some(3),
            ..ConfigFile::default()
        };
        let leases =
            LeaseArguments { lease_s: Some(2.0), drain_s: None }.lease_settings(&file).unwrap();
        assert_eq!((leases.lease.as_secs(), leases.drain.as_secs()), (2, 1));
        let none = LeaseArguments { lease_s: None, drain_s: None };
        assert_eq!(none.lease_settings(&ConfigFile::default()).unwrap(), LeaseSettings::default());
        assert_eq!((worker_count(Some(5), &file, 1), worker_count(None, &file, 1)), (Ok(5), Ok(3)));
        assert_eq!(worker_count(None, &ConfigFile::default(), 1), Ok(1));
    }

    #[test]
    fn memory_is_given_in_megabytes() {
        assert_eq!(memory_bytes("job_memory_mb", None, Some(64), 7), Ok(64 << 20));
        assert_eq!(memory_bytes("job_memory_mb", Some(32), Some(64), 7), Ok(32 << 20));
        assert_eq!(memory_bytes("job_memory_mb", None, None, 7), Ok(7));
        let wrong = memory_bytes("job_memory_mb", Some(8), None, 7).unwrap_err();
        assert!(wrong.message().unwrap().contains("job_memory_mb must be from 32"));
    }

    #[test]
    fn what_is_out_of_bounds_is_named() {
        let lease = |lease_s| {
            LeaseArguments { lease_s: Some(lease_s), drain_s: None }
                .lease_settings(&ConfigFile::default())
        };
        for wrong in [0.1, 3601.0, f64::NAN] {
            assert!(lease(wrong).is_err_and(|why| {
                why.message().unwrap().contains("lease_s must be from 0.5 to 3600")
            }));
        }
        let file = ConfigFile { drain_s: Some(-1.0), workers: Some(65), ..ConfigFile::default() };
        assert!(
            LeaseArguments { lease_s: None, drain_s: None }
                .lease_settings(&file)
                .unwrap_err()
                .message()
                .unwrap()
                .contains("drain_s")
        );
        assert!(worker_count(None, &file, 0).is_err() && worker_count(Some(0), &file, 1).is_err());
    }

    /// This test's program as another process, which runs one test in earnest.
    #[cfg(unix)]
    fn stopped(role: &str, test: &str) -> (Option<i32>, Duration) {
        use std::io::{BufRead as _, BufReader};
        use std::process::{Command, Stdio};
        let mut command = Command::new(std::env::current_exe().unwrap());
        let name = format!("commands::running::tests::{test}");
        command.args(["--exact", &name, "--nocapture"]).env(ROLE, role).stdout(Stdio::piped());
        let mut process = command.spawn().unwrap();
        let mut lines = BufReader::new(process.stdout.take().unwrap()).lines();
        assert!(lines.any(|line| line.unwrap().contains("begun")));
        std::thread::sleep(Duration::from_millis(200));
        let told = std::time::Instant::now();
        assert!(
            Command::new("kill")
                .args(["-TERM", &process.id().to_string()])
                .status()
                .unwrap()
                .success()
        );
        let code = process.wait().unwrap().code();
        (code, told.elapsed())
    }

    #[cfg(unix)]
    const ROLE: &str = "SISTERSHIP_TEST_ROLE";

    #[cfg(unix)]
    #[test]
    fn a_process_ends_in_time_whatever_holds_its_threads() {
        let long = || std::thread::sleep(Duration::from_secs(600));
        let begun = || println!("begun");
        match std::env::var(ROLE).ok().as_deref() {
            Some("computes") => {
                let start = async {
                    drop(tokio::task::spawn_blocking(long));
                    begun();
                    Ok(())
                };
                run_until_stopped(Duration::from_secs(60), start, async |()| {}).unwrap();
                std::process::exit(0);
            }
            Some("held") => {
                let start = async {
                    for _ in 0..64 {
                        drop(tokio::spawn(async move { long() }));
                    }
                    begun();
                    Ok(())
                };
                let stop = async |()| tokio::task::spawn(async {}).await.unwrap();
                run_until_stopped(Duration::from_secs(2), start, stop).unwrap();
                std::process::exit(0);
            }
            _ => {
                let test = "a_process_ends_in_time_whatever_holds_its_threads";
                let (code, took) = stopped("computes", test);
                assert!(
                    code == Some(0) && took < Duration::from_secs(2),
                    "a blocking thread: {code:?} after {took:?}"
                );
                let (code, took) = stopped("held", test);
                assert!(
                    code == Some(1) && took < Duration::from_secs(5),
                    "every thread: {code:?} after {took:?}"
                );
            }
        }
    }
}
