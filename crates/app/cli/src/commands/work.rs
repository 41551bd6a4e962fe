//! `sistership work`: workers without a server.

use clap::Args;
use sistership_api::{Config, Workers};

use super::config_file::ConfigFile;
use super::log::LogArguments;
use super::running::{LeaseArguments, memory_bytes, run_until_stopped, worker_count};
use super::store::StoreArguments;
use crate::failure::Failure;
use crate::output;

const EXAMPLES: &str = "\
Examples:
  sistership work --data-dir /var/lib/sistership
  sistership work --workers 8 --database-url postgres://user@host/sistership --data-dir /mnt/shared/sistership

Any number of workers may run in addition to `sistership serve` (which runs no jobs with
--no-worker), on any machines that reach the same database and the same samples. A job is run by one
worker at a time; if that worker stops, another takes over the job after --lease-s. Stop it with
Ctrl-C or SIGTERM: running jobs get --drain-s to finish and then return to the queue.";

/// Run a worker for the jobs that servers have queued.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct WorkArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Number of concurrent jobs, 1 to 64 [default: 1].
    #[arg(long, value_name = "N", env = "SISTERSHIP_WORKERS")]
    workers: Option<u16>,
    /// Memory for all jobs together, MB, at least 32 [default: 1024].
    #[arg(long, value_name = "MB", env = "SISTERSHIP_JOB_MEMORY_MB")]
    job_memory_mb: Option<u64>,
    #[command(flatten)]
    lease: LeaseArguments,
    #[command(flatten)]
    log: LogArguments,
}

/// Runs the command until it is stopped.
///
/// # Errors
/// Returns an error if the configuration is refused, or if the store cannot be used.
pub fn run(work: &WorkArguments) -> Result<(), Failure> {
    let file = work.store.read_config()?;
    let config = worker_config(work, &file)?;
    let _traces = work.log.start_log(&file)?;
    let start = async {
        let workers = Workers::start(config.clone())
            .await
            .map_err(|error| Failure::Refused(error.to_string()))?;
        output::print_result(false, &(), || {
            format!("sistership worker started as process {}", std::process::id())
        })?;
        Ok(workers)
    };
    run_until_stopped(config.stop_deadline(), start, Workers::stop)
}

fn worker_config(work: &WorkArguments, file: &ConfigFile) -> Result<Config, Failure> {
    let place = work.store.resolve_place(file)?;
    let mut config = Config::new(place.data_dir);
    config.objects = place.objects;
    config.database_url = place.database_url;
    // At least one: a process without workers would do nothing.
    config.workers = worker_count(work.workers, file, 1)?;
    config.limits.job_memory = memory_bytes(
        "job_memory_mb",
        work.job_memory_mb,
        file.job_memory_mb,
        config.limits.job_memory,
    )?;
    config.leases = work.lease.lease_settings(file)?;
    Ok(config)
}
