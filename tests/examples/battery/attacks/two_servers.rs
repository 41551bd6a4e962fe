//! `two servers`: two servers behind one proxy and four workers on one database and one bucket,
//! under load, while one of the processes is killed every 20 s.

use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rand::RngExt as _;
use rand_chacha::ChaCha12Rng;
use reqwest::Method;
use serde_json::Value;
use sistership_store::testing::TestS3;
use tokio::task::JoinSet;

use super::workers;
use crate::attack::{Attack, Failure, Field, Running};
use crate::balancer::Balancer;
use crate::client::Client;
use crate::documents;
use crate::ledger::Shared;
use crate::place::Place;
use crate::process::{Process, Server};
use crate::writes::{FOR_ONE_SHIP, Kind, Write};

const SERVERS: usize = 2;
const WORKERS: usize = 4;
const WRITERS: u64 = 3;
const READERS: u64 = 3;
/// Time between two kills.
const INTERVAL: Duration = Duration::from_secs(20);
/// Kills, however little time there is.
const FEWEST: usize = 3;
/// Time until a service manager starts a process again.
const RESTART: Duration = Duration::from_secs(1);
/// Pause between two requests of one client, ms.
const PAUSE_MS: std::ops::Range<u64> = 20..120;
/// Pause between two refinements; none is requested while one waits or runs for each worker.
const JOB_PAUSE: Duration = Duration::from_secs(4);
/// Longer than the key of a request is held for a process that has been killed.
const KEY_HELD: Duration = Duration::from_secs(75);
/// Time for all jobs to end after the load.
const DRAINED: Duration = Duration::from_secs(300);
/// A client whose requests are not answered for this long has lost its service.
const SERVED: Duration = Duration::from_secs(10);

/// The attack.
pub struct TwoServers;

impl Attack for TwoServers {
    fn name(&self) -> &'static str {
        "two servers"
    }

    fn share(&self) -> f64 {
        2.0
    }

    fn works(&self) -> bool {
        true
    }

    fn least_minutes(&self) -> f64 {
        5.0
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

/// Times of requests from the first attempt to the answer.
#[derive(Default)]
struct Times {
    reads: Mutex<Vec<Duration>>,
    writes: Mutex<Vec<Duration>>,
}

/// What all clients share.
struct Load {
    shared: Shared,
    times: Times,
    client: Client,
}

/// The processes of one installation.
struct Installation {
    place: Place,
    balancer: Balancer,
    servers: Vec<Server>,
    workers: Vec<Process>,
}

async fn run(field: &Field) -> Result<(), Failure> {
    let s3 = TestS3::start().await;
    let mut installation = Installation::start(field, &s3).await?;
    let client = Client::new(installation.balancer.address, Arc::clone(&field.tally));
    workers::prepare(&client).await?;
    let (shared, times) = (Shared::new(&field.tally), Times::default());
    let load = Arc::new(Load { shared, times, client });
    let mut clients = JoinSet::new();
    for number in 0..WRITERS {
        clients.spawn(write(Arc::clone(&load), number, field.rng(number)));
    }
    for number in 0..READERS {
        clients.spawn(read(Arc::clone(&load), field.rng(WRITERS + number)));
    }
    clients.spawn(refine(Arc::clone(&load)));
    let kills = kill_in_turn(field, &mut installation).await?;
    load.shared.stop.store(true, Ordering::SeqCst);
    while let Some(done) = clients.join_next().await {
        done??;
    }
    let repeated = settle_unanswered(&load).await;
    let (jobs, retried) = settle_jobs(field, &load.client).await?;
    load.shared.ledger.check(&load.client, &field.tally).await;
    installation.stop();
    installation.place.check("after the kills of servers and workers").await?;
    let entries = load.shared.ledger.entries();
    let acknowledged = entries.iter().filter(|entry| entry.acknowledged.is_some()).count();
    field.tally.remark(format!(
        "{kills} kills; {acknowledged} writes acknowledged, {repeated} of them repeated at the \
         end; {jobs} refinements, {retried} retried after two deaths; {}; {}",
        quantiles("reads", &load.times.reads),
        quantiles("writes", &load.times.writes)
    ));
    Ok(())
}

impl Installation {
    async fn start(field: &Field, s3: &TestS3) -> Result<Self, Failure> {
        let mut place = field.place().await?;
        for (flag, value) in s3.store_options("fleet") {
            place.objects.extend([flag.into(), value.into()]);
        }
        place.environment = s3.environment_credentials().to_vec();
        let (mut servers, mut workers) = (Vec::new(), Vec::new());
        for _ in 0..SERVERS {
            servers.push(place.serve().await?);
        }
        for _ in 0..WORKERS {
            workers.push(place.start().worker().await?);
        }
        let addresses = servers.iter().map(|server| server.client.address).collect();
        Ok(Self { place, balancer: Balancer::start(addresses).await?, servers, workers })
    }

    /// Kills one of the processes, and starts it again as a service manager does.
    async fn kill_one(&mut self, victim: usize) -> Result<(), Failure> {
        match victim.checked_sub(SERVERS) {
            None => {
                self.servers.remove(victim).process.kill();
                tokio::time::sleep(RESTART).await;
                let server = self.place.serve().await?;
                self.balancer.replace(victim, server.client.address);
                self.servers.insert(victim, server);
            }
            Some(worker) => {
                self.workers.remove(worker).kill();
                tokio::time::sleep(RESTART).await;
                self.workers.insert(worker, self.place.start().worker().await?);
            }
        }
        Ok(())
    }

    fn stop(&mut self) {
        self.servers.drain(..).for_each(|server| server.process.kill());
        self.workers.drain(..).for_each(Process::kill);
    }
}

/// Kills a process at each interval, servers and workers in turn; returns how many.
async fn kill_in_turn(field: &Field, installation: &mut Installation) -> Result<usize, Failure> {
    let (mut rng, mut kills) = (field.rng(WRITERS + READERS), 0);
    while kills < FEWEST || field.left() > INTERVAL {
        tokio::time::sleep(INTERVAL - RESTART).await;
        let victim = match kills % 2 {
            0 => rng.random_range(0..SERVERS),
            _ => SERVERS + rng.random_range(0..WORKERS),
        };
        installation.kill_one(victim).await?;
        kills += 1;
    }
    Ok(kills)
}

impl Load {
    fn is_over(&self) -> bool {
        self.shared.stop.load(Ordering::SeqCst)
    }

    /// Sends a write, under its key again where no answer came, and keeps the time it took.
    async fn send(&self, write: &Write) -> Option<bool> {
        let Shared { ledger, tally, .. } = &self.shared;
        let (begun, place) = (Instant::now(), ledger.begin(write));
        let mut known = ledger.send(place, &self.client, tally).await;
        while known.is_none() && begun.elapsed() < SERVED {
            known = ledger.repeat(place, &self.client, tally).await;
        }
        if known.is_none() {
            tally.wrong(format!("no answer to {:?} {} for {SERVED:?}", write.kind, write.mark));
        }
        self.times.writes.lock().unwrap_or_else(PoisonError::into_inner).push(begun.elapsed());
        known
    }
}

/// One writer, on ships of its own.
async fn write(load: Arc<Load>, number: u64, mut rng: ChaCha12Rng) -> Result<(), Failure> {
    let mut ship = String::new();
    for count in 0.. {
        if load.is_over() {
            break;
        }
        if count % FOR_ONE_SHIP == 0 {
            ship = format!("shared-{number}-{}", count / FOR_ONE_SHIP);
            for first in &Write::first(&ship, number)? {
                until_taken(&load, first).await;
            }
        }
        let write = Write::any(&load.client, &ship, count, &mut rng).await?;
        load.send(&write).await;
        tokio::time::sleep(Duration::from_millis(rng.random_range(PAUSE_MS))).await;
    }
    Ok(())
}

/// Sends what later writes need until it is acknowledged.
async fn until_taken(load: &Load, write: &Write) {
    let Shared { ledger, tally, .. } = &load.shared;
    let (begun, place) = (Instant::now(), ledger.begin(write));
    while ledger.send(place, &load.client, tally).await != Some(true) {
        if begun.elapsed() > KEY_HELD {
            return tally.wrong(format!("{:?} {} is not taken", write.kind, write.mark));
        }
        tokio::time::sleep(Duration::from_millis(200)).await;
    }
}

/// One reader of what is read most.
async fn read(load: Arc<Load>, mut rng: ChaCha12Rng) -> Result<(), Failure> {
    let paths = [
        format!("/v1/ships/{}/model", documents::PATTERN),
        format!("/v1/ships/{}", workers::SHIP),
        "/v1/ships?limit=20".to_owned(),
        format!("/v1/jobs?ship={}", workers::SHIP),
    ];
    while !load.is_over() {
        let path = &paths[rng.random_range(0..paths.len())];
        let begun = Instant::now();
        let answered = async || {
            let request = load.client.request(Method::GET, path);
            load.client.send(request).await.is_some_and(|reply| reply.ok())
        };
        while !answered().await {
            if begun.elapsed() > SERVED {
                load.shared.tally.wrong(format!("no answer to GET {path} for {SERVED:?}"));
                break;
            }
        }
        load.times.reads.lock().unwrap_or_else(PoisonError::into_inner).push(begun.elapsed());
        tokio::time::sleep(Duration::from_millis(rng.random_range(PAUSE_MS))).await;
    }
    Ok(())
}

/// Queues refinements that the workers can complete.
async fn refine(load: Arc<Load>) -> Result<(), Failure> {
    for count in 0.. {
        if load.is_over() {
            break;
        }
        if workers::unfinished(&load.client).await < WORKERS {
            load.send(&Write::refinement(workers::SHIP, &format!("work-{count}"))).await;
        }
        tokio::time::sleep(JOB_PAUSE).await;
    }
    Ok(())
}

/// Repeats each write with a key that was not acknowledged, until it is; returns how many.
async fn settle_unanswered(load: &Load) -> usize {
    let Shared { ledger, tally, .. } = &load.shared;
    let unanswered: Vec<usize> = ledger
        .entries()
        .iter()
        .enumerate()
        .filter(|(_, entry)| entry.acknowledged.is_none() && entry.write.kind != Kind::Alias)
        .map(|(place, _)| place)
        .collect();
    let begun = Instant::now();
    for &place in &unanswered {
        while ledger.repeat(place, &load.client, tally).await != Some(true) {
            if begun.elapsed() > KEY_HELD {
                let mark = ledger.entries()[place].write.mark.clone();
                tally.wrong(format!("{mark} is not taken under its key {KEY_HELD:?} after a kill"));
                break;
            }
            tokio::time::sleep(Duration::from_millis(200)).await;
        }
    }
    unanswered.len()
}

/// Waits until all refinements have ended, each by one version; those that were set aside because
/// both their workers were killed are retried. Returns how many there are, and were retried.
async fn settle_jobs(field: &Field, client: &Client) -> Result<(usize, usize), Failure> {
    workers::finished(client, DRAINED).await?;
    let mut retried = 0;
    for job in workers::all_jobs(client).await {
        let twice = job["error"].to_string().contains("ended its process twice");
        if job["state"] == "failed" && twice {
            let path = format!("/v1/jobs/{}/retry", job["id"].as_str().unwrap_or_default());
            client.try_send(client.request(Method::POST, &path)).await?;
            retried += 1;
        }
    }
    workers::finished(client, DRAINED).await?;
    let all: Vec<Value> = workers::all_jobs(client).await;
    workers::judge_versions(field, client, &all).await;
    Ok((all.len(), retried))
}

/// Median, 99th percentile and maximum of times.
fn quantiles(what: &str, times: &Mutex<Vec<Duration>>) -> String {
    let mut times = times.lock().unwrap_or_else(PoisonError::into_inner).clone();
    times.sort_unstable();
    let at = |part: usize| times.get(times.len() * part / 100).map_or(0, Duration::as_millis);
    let most = times.last().map_or(0, Duration::as_millis);
    format!("{} {what}: p50 {} ms, p99 {} ms, most {most} ms", times.len(), at(50), at(99))
}
