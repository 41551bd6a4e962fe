//! `sistership work`: workers without a server.

use clap::Args;
use sistership_server::{Config, Workers};

use super::running::{LeaseArguments, log, until_stopped};
use super::store::{StoreArguments, block_on};
use crate::failure::Failure;
use crate::output;

const EXAMPLES: &str = "\
Examples:
  sistership work --data-dir /var/lib/sistership
  sistership work --workers 8 --database-url postgres://user@host/sistership --data-dir /mnt/shared/sistership

Any number of such processes may run beside `sistership serve` (which leaves all work to them with --no-worker), on any
machines that reach the same database and the same samples. A job belongs to one of them at a time; when that one dies,
its job goes to another after --lease-s. Stop it with Ctrl-C or SIGTERM: jobs under way go back to the queue.";

/// Work on the jobs that servers queue, without serving.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Work {
    #[command(flatten)]
    store: StoreArguments,
    /// Jobs worked on at a time.
    #[arg(long, value_name = "N", env = "SISTERSHIP_WORKERS", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=64))]
    workers: u16,
    #[command(flatten)]
    lease: LeaseArguments,
}

/// Runs the command until it is told to stop.
///
/// # Errors
/// The configuration is refused, or the store cannot be used.
pub fn run(work: &Work) -> Result<(), Failure> {
    let config = config(work);
    log();
    block_on(async {
        let workers = Workers::start(config).await.map_err(|error| Failure::Refused(error.to_string()))?;
        output::print(false, &(), || format!("sistership works as process {}", std::process::id()))?;
        until_stopped(workers.stop()).await
    })
}

fn config(work: &Work) -> Config {
    let mut config = Config::new(&work.store.data_dir);
    config.database_url = work.store.url();
    config.workers = usize::from(work.workers);
    config.leases = work.lease.leases();
    config
}
