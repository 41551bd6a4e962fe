//! The battery: attacks on the built program, over HTTP and by signals, and one table of what they
//! found.
//!
//! `cargo run --release -p sistership-tests --example battery -- --minutes 20`
//!
//! `docs/reliability.md` says what is attacked and what the columns mean. The exit status is 1
//! where anything was lost, wrong or aborted, answered with 5xx other than 503 and 507, or took
//! more memory than it may.

mod arguments;
mod attack;
mod attacks;
mod balancer;
mod client;
mod documents;
mod faults;
mod gate;
mod ledger;
mod place;
mod process;
mod table;
mod tally;
mod writes;

use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use arguments::Arguments;
use attack::{Attack, Failure, Field};
use faults::Faults;
use place::Database;
use table::Row;
use tally::Tally;

/// What a process may take beyond its budgets, MB.
const BEYOND_MB: u64 = 64;

#[tokio::main]
async fn main() -> ExitCode {
    sistership_store::provide_cryptography();
    let arguments = match Arguments::read(std::env::args().skip(1)) {
        Ok(arguments) => arguments,
        Err(message) => {
            eprintln!("error: {message}");
            return ExitCode::from(2);
        }
    };
    match run(arguments).await {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

async fn run(arguments: Arguments) -> Result<bool, Failure> {
    if let Some(program) = &arguments.program {
        process::choose(program.clone());
    }
    eprintln!("{} by seed {}", process::program().display(), arguments.seed);
    let faults = Faults::build()?.map(Arc::new);
    let mut rows = Vec::new();
    for &database in &arguments.databases {
        let mut left = Duration::from_secs_f64(60.0 * arguments.minutes);
        let attacks: Vec<_> =
            attacks::all().into_iter().filter(|attack| arguments.takes(attack.as_ref())).collect();
        for (place, attack) in attacks.iter().enumerate() {
            let shares: f64 = attacks[place..].iter().map(|attack| attack.share()).sum();
            let part = left.mul_f64(attack.share() / shares);
            let row = one(attack.as_ref(), database, part, &arguments, faults.clone()).await;
            left = left.saturating_sub(row.took);
            rows.push(row);
        }
    }
    Ok(table::print(&rows))
}

/// One attack on one database. What keeps it from going on counts as wrong.
async fn one(
    attack: &dyn Attack,
    database: Database,
    part: Duration,
    arguments: &Arguments,
    faults: Option<Arc<Faults>>,
) -> Row {
    let (begun, tally) = (Instant::now(), Arc::new(Tally::default()));
    eprintln!("{} on {}, {:.0} s", attack.name(), database.name(), part.as_secs_f64());
    let field = Field {
        database,
        seed: arguments.seed,
        until: begun + part,
        tally: Arc::clone(&tally),
        faults,
    };
    if let Err(failure) = attack.run(&field).await {
        tally.wrong(format!("the attack broke off: {failure}"));
    }
    let jobs_mb = if attack.works() { arguments.jobs_mb } else { 0 };
    Row::new(
        database.name(),
        attack.name(),
        &tally,
        arguments.requests_mb + jobs_mb + BEYOND_MB,
        begun.elapsed(),
    )
}
