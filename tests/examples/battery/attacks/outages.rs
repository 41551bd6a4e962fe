//! `outages`: the database or the bucket does not answer, or answers wrongly, while writers write.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use rand::RngExt as _;
use rand_chacha::ChaCha12Rng;
use reqwest::Method;
use sistership_store::testing::TestS3;
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::gate::{Gate, Mode};
use crate::ledger::Shared;
use crate::place::{Database, Place};
use crate::writes::Write;

const WRITERS: u64 = 3;
/// A part that answers again must be used again within this.
const RECOVERY: Duration = Duration::from_secs(15);
/// `/readyz` must answer within this, whatever happens.
const READINESS: Duration = Duration::from_secs(1);
/// The name of PostgreSQL's socket in its folder.
const SOCKET: &str = ".s.PGSQL.5432";

/// The attack.
pub struct Outages;

impl Attack for Outages {
    fn name(&self) -> &'static str {
        "outages"
    }

    fn least_minutes(&self) -> f64 {
        5.0
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

/// What is done to a part.
#[derive(Debug, Clone, Copy)]
enum Fault {
    /// Its connections are forgotten; new ones pass.
    Forgotten,
    /// A mode for a time.
    For(Mode, Duration),
}

async fn run(field: &Field) -> Result<(), Failure> {
    let until = Instant::now() + field.left().mul_f64(0.5);
    if field.database == Database::Postgres {
        database(field, until).await?;
    }
    bucket(field).await
}

/// The database: forgotten, cut, refused and stalled connections.
async fn database(field: &Field, until: Instant) -> Result<(), Failure> {
    let mut place = field.place().await?;
    let url = place.database.url.clone();
    let (front, folder) = url.split_once("?host=").ok_or("no socket of PostgreSQL")?;
    let folder = Path::new(folder).to_owned();
    let gate = Gate::before_socket(place.folder().join(SOCKET), folder.join(SOCKET))?;
    place.url = format!("{front}?host={}", place.folder().display());
    let faults = [
        Fault::Forgotten,
        Fault::For(Mode::Refused, Duration::from_secs(2)),
        Fault::Forgotten,
        Fault::For(Mode::Stalled, Duration::from_secs(3)),
    ];
    let worst = faulty(field, &place, &gate, &faults, until).await?;
    field.tally.remark(format!("database back after {:.1} s at most", worst.as_secs_f64()));
    Ok(())
}

/// The bucket: faults by status, refused and stalled connections; and a start without it.
async fn bucket(field: &Field) -> Result<(), Failure> {
    let s3 = TestS3::start().await;
    let mut place = field.place().await?;
    let [(_, url), (flag, endpoint)] = s3.store_options("fleet");
    let (gate, address) =
        Gate::before_address(endpoint.trim_start_matches("http://").to_owned()).await?;
    place.objects = vec!["--objects-url".into(), url.into(), flag.into()];
    place.objects.push(format!("http://{address}").into());
    place.environment = s3.environment_credentials().to_vec();
    let second = Duration::from_secs(1);
    let faults = [
        Fault::For(Mode::Answers(500), 2 * second),
        Fault::For(Mode::Answers(503), 2 * second),
        Fault::For(Mode::Answers(403), 2 * second),
        Fault::For(Mode::Refused, 2 * second),
        Fault::For(Mode::Stalled, 3 * second),
    ];
    let worst = faulty(field, &place, &gate, &faults, field.until).await?;
    field.tally.remark(format!("bucket back after {:.1} s at most", worst.as_secs_f64()));
    gate.set(Mode::Answers(503));
    let begun = Instant::now();
    let server = place.serve().await?;
    field.tally.remark(format!("start without a bucket {:.1} s", begun.elapsed().as_secs_f64()));
    if server.client.get("/v1/ships").await.is_null() {
        field.tally.wrong("without its bucket a server does not list ships");
    }
    server.process.kill();
    Ok(())
}

/// Writers write while faults come one after the other, each at least once; gives the longest time
/// until a write was acknowledged after a fault.
async fn faulty(
    field: &Field,
    place: &Place,
    gate: &Gate,
    faults: &[Fault],
    until: Instant,
) -> Result<Duration, Failure> {
    let server = place.serve().await?;
    let (client, shared) = (&server.client, Arc::new(Shared::new(&field.tally)));
    let mut writers = JoinSet::new();
    for number in 0..WRITERS {
        writers.spawn(write(Arc::clone(&shared), client.clone(), number, field.rng(number)));
    }
    let (mut rng, mut worst, mut count) = (field.rng(WRITERS), Duration::ZERO, 0);
    while count < faults.len() || Instant::now() < until {
        tokio::time::sleep(Duration::from_millis(rng.random_range(200..1500))).await;
        let fault = faults[count % faults.len()];
        count += 1;
        strike(field, gate, client, fault).await;
        worst = worst.max(recovered(field, client, fault, count).await);
    }
    shared.stop.store(true, Ordering::SeqCst);
    while let Some(written) = writers.join_next().await {
        written??;
    }
    shared.ledger.check(client, &field.tally).await;
    server.process.kill();
    place.check("after the outages").await?;
    let entries = shared.ledger.entries();
    let acknowledged = entries.iter().filter(|entry| entry.acknowledged.is_some()).count();
    field.tally.remark(format!("{count} outages, {acknowledged} writes acknowledged"));
    Ok(worst)
}

/// Lets a fault happen, and asks meanwhile whether the server is ready.
async fn strike(field: &Field, gate: &Gate, client: &Client, fault: Fault) {
    match fault {
        Fault::Forgotten => {
            gate.forget();
            is_ready(field, client, fault).await;
        }
        Fault::For(mode, time) => {
            gate.set(mode);
            let end = Instant::now() + time;
            while Instant::now() < end {
                is_ready(field, client, fault).await;
                tokio::time::sleep(Duration::from_millis(200)).await;
            }
            gate.set(Mode::Open);
        }
    }
}

async fn is_ready(field: &Field, client: &Client, fault: Fault) {
    let begun = Instant::now();
    let answer = client.send(client.request(Method::GET, "/readyz")).await;
    let took = begun.elapsed();
    if answer.is_none() || took > READINESS + READINESS / 2 {
        field.tally.wrong(format!("/readyz took {took:.1?} during {fault:?}"));
    }
}

/// Uploads until one is taken.
async fn recovered(field: &Field, client: &Client, fault: Fault, count: usize) -> Duration {
    let begun = Instant::now();
    let ship = format!("after-outages-{count}");
    let writes = [Write::ship(&ship), Write::trial(&ship, "trial", count as u64)];
    for write in &writes {
        while !write.send(client).await.is_some_and(|reply| reply.ok()) {
            if begun.elapsed() > 4 * RECOVERY {
                break;
            }
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
    }
    let took = begun.elapsed();
    if took > RECOVERY {
        field.tally.wrong(format!("no write for {took:.1?} after {fault:?}"));
    }
    took
}

/// One writer, on ships of its own; what is not answered well is sent again under its key.
async fn write(
    shared: Arc<Shared>,
    client: Client,
    number: u64,
    mut rng: ChaCha12Rng,
) -> Result<(), Failure> {
    let Shared { ledger, tally, stop } = shared.as_ref();
    let stopped = |stop: &AtomicBool| stop.load(Ordering::SeqCst);
    let ship = format!("outage-{number}");
    for first in &Write::first(&ship, number)? {
        let place = ledger.begin(first);
        while ledger.send(place, &client, tally).await != Some(true) && !stopped(stop) {
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
    }
    for count in 0.. {
        // A ship has at most a hundred tags.
        if stopped(stop) || count > 900 {
            break;
        }
        let write = Write::any(&client, &ship, count, &mut rng).await?;
        let place = ledger.begin(&write);
        let mut known = ledger.send(place, &client, tally).await;
        while known.is_none() && !stopped(stop) {
            tokio::time::sleep(Duration::from_millis(100)).await;
            known = ledger.repeat(place, &client, tally).await;
        }
    }
    Ok(())
}
