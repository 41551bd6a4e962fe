//! The requests, their times, and what must be true of their answers.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use reqwest::Client;
use tokio::sync::Semaphore;
use tokio::task::JoinSet;

use crate::Failure;
use crate::registry::{Moved, Registry};

/// Clients that write at once.
const WRITERS: usize = 8;
/// Connections that read at once.
const READERS: usize = 16;
/// Requests a second, over all connections, of the readers that do not hurry.
const PACE: usize = 500;
/// Connections of those that all come at once; servers bound them.
const CROWD: usize = 256;

/// How many of each.
#[derive(Debug, Clone)]
pub struct Sizes {
    pub models: usize,
    pub versions: usize,
    pub reads: usize,
    pub creations: usize,
    pub moves: usize,
}

impl Default for Sizes {
    fn default() -> Self {
        Self { models: 100, versions: 100, reads: 20_000, creations: 2000, moves: 500 }
    }
}

/// What came of it: what was measured, and the figure.
pub type Figures = Vec<(String, String)>;

fn name(model: usize) -> String {
    format!("bench-{model:05}")
}

pub async fn drive(registry: &Registry, sizes: &Sizes) -> Result<Figures, Failure> {
    let mut figures = load(registry, sizes).await?;
    registry.settle(&Client::new(), sizes.models).await?;
    let fast = read(registry, sizes, None).await?;
    figures.push((
        format!("champion, {READERS} connections without pause: requests/s"),
        rate(sizes.reads, fast.elapsed),
    ));
    figures.push(("the same: p50, p99, ms".to_owned(), fast.quantiles()));
    let paced = read(registry, sizes, Some(PACE)).await?;
    figures.push((
        format!("champion, {READERS} connections, {PACE} requests/s: p50, p99, ms"),
        paced.quantiles(),
    ));
    figures.extend(crowd(registry, sizes).await?);
    figures.extend(race(registry, sizes).await?);
    Ok(figures)
}

struct Times {
    all: Vec<Duration>,
    elapsed: Duration,
}

impl Times {
    fn quantile(&self, of: f64) -> f64 {
        let last = self.all.len().saturating_sub(1) as f64;
        self.all.get((of * last).round() as usize).map_or(f64::NAN, |time| 1e3 * time.as_secs_f64())
    }

    fn quantiles(&self) -> String {
        format!("{:.2}, {:.2}", self.quantile(0.5), self.quantile(0.99))
    }
}

fn rate(count: usize, elapsed: Duration) -> String {
    format!("{:.0}", count as f64 / elapsed.as_secs_f64())
}

/// Does `count` pieces of work over some clients, each of which takes the next piece as soon as it
/// is done with one.
async fn over<F>(
    clients: usize,
    count: usize,
    work: impl Fn(Client, usize) -> F + Send + Sync + Clone + 'static,
) -> Result<Times, Failure>
where
    F: Future<Output = Result<(), Failure>> + Send,
{
    let (next, start, mut tasks) = (Arc::new(AtomicUsize::new(0)), Instant::now(), JoinSet::new());
    for _ in 0..clients {
        let (next, work, client) = (Arc::clone(&next), work.clone(), Client::new());
        tasks.spawn(async move {
            let mut times = Vec::new();
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                if index >= count {
                    return Ok::<_, Failure>(times);
                }
                let begun = Instant::now();
                work(client.clone(), index).await?;
                times.push(begun.elapsed());
            }
        });
    }
    let mut all = Vec::with_capacity(count);
    while let Some(times) = tasks.join_next().await {
        all.extend(times??);
    }
    let elapsed = start.elapsed();
    all.sort_unstable();
    Ok(Times { all, elapsed })
}

/// Models with versions, the last one champion.
async fn load(registry: &Registry, sizes: &Sizes) -> Result<Figures, Failure> {
    let (at, models) = (registry.clone(), sizes.models);
    over(WRITERS, models, move |client, model| {
        let at = at.clone();
        async move { at.model(&client, &name(model)).await }
    })
    .await?;
    let (at, count) = (registry.clone(), sizes.models * sizes.versions);
    let made = over(WRITERS, count, move |client, index| {
        let at = at.clone();
        async move { at.create(&client, &name(index % models)).await.map(drop) }
    });
    let made = made.await?;
    let (at, last) = (registry.clone(), sizes.versions as u64);
    over(WRITERS, models, move |client, model| {
        let at = at.clone();
        async move { at.crown(&client, &name(model), last).await }
    })
    .await?;
    Ok(vec![
        (
            format!("{count} versions of {models} models, {WRITERS} clients: created/s"),
            rate(count, made.elapsed),
        ),
        ("the same: p50, p99, ms".to_owned(), made.quantiles()),
    ])
}

/// Reads champions, as fast as they come or at a pace.
async fn read(registry: &Registry, sizes: &Sizes, pace: Option<usize>) -> Result<Times, Failure> {
    let (at, models) = (registry.clone(), sizes.models);
    let count = pace.map_or(sizes.reads, |pace| (10 * pace).min(sizes.reads));
    match pace {
        None => {
            let work = move |client: Client, index: usize| {
                let at = at.clone();
                async move { at.champion(&client, &name(index % models)).await }
            };
            over(READERS, count, work).await
        }
        Some(pace) => paced(registry, models, count, pace).await,
    }
}

/// Each connection asks at its own even beat; a late answer delays the next question, and that
/// delay counts as its time.
async fn paced(
    registry: &Registry,
    models: usize,
    count: usize,
    pace: usize,
) -> Result<Times, Failure> {
    let (start, beat, mut tasks) =
        (Instant::now(), Duration::from_secs_f64(READERS as f64 / pace as f64), JoinSet::new());
    for reader in 0..READERS {
        let (at, client) = (registry.clone(), Client::new());
        tasks.spawn(async move {
            let mut times = Vec::new();
            let first = start + beat.mul_f64(reader as f64 / READERS as f64);
            for turn in 0..count / READERS {
                let due = first + beat.mul_f64(turn as f64);
                tokio::time::sleep_until(due.into()).await;
                // The timer has a millisecond's grain, which is not the registry's.
                let begun =
                    if due.elapsed() < Duration::from_millis(2) { Instant::now() } else { due };
                at.champion(&client, &name((reader + turn * READERS) % models)).await?;
                times.push(begun.elapsed());
            }
            Ok::<_, Failure>(times)
        });
    }
    let mut all = Vec::with_capacity(count);
    while let Some(times) = tasks.join_next().await {
        all.extend(times??);
    }
    all.sort_unstable();
    Ok(Times { all, elapsed: start.elapsed() })
}

/// Everybody makes a version of one model at once.
async fn crowd(registry: &Registry, sizes: &Sizes) -> Result<Figures, Failure> {
    let (client, seats, model) =
        (Client::new(), Arc::new(Semaphore::new(CROWD)), name(sizes.models));
    registry.model(&client, &model).await?;
    let (start, mut tasks) = (Instant::now(), JoinSet::new());
    for _ in 0..sizes.creations {
        let (at, client, seats, model) =
            (registry.clone(), client.clone(), Arc::clone(&seats), model.clone());
        tasks.spawn(async move {
            let _seat = seats.acquire().await?;
            at.create(&client, &model).await
        });
    }
    let (mut numbers, mut failed) = (Vec::new(), 0);
    while let Some(made) = tasks.join_next().await {
        match made? {
            Ok(number) => numbers.push(number),
            Err(_) => failed += 1,
        }
    }
    let elapsed = start.elapsed();
    numbers.sort_unstable();
    let whole = numbers.iter().copied().eq(1..=numbers.len() as u64);
    let judged = format!("{}, {failed} failed", if whole { "no gap" } else { "GAPS or repeats" });
    let label = format!("{} concurrent versions of one model", sizes.creations);
    Ok(vec![
        (format!("{label}: numbers"), judged),
        (format!("{label}: created/s"), rate(numbers.len(), elapsed)),
    ])
}

/// Everybody moves the same alias from where it stands, at once.
async fn race(registry: &Registry, sizes: &Sizes) -> Result<Figures, Failure> {
    let (client, seats, model) = (Client::new(), Arc::new(Semaphore::new(CROWD)), name(0));
    let label = format!("{} concurrent moves of one alias with If-Match: winners", sizes.moves);
    let Some(tag) = registry.tag(&client, &model).await? else {
        return Ok(vec![(label, "not offered".to_owned())]);
    };
    let (start, mut tasks) = (Instant::now(), JoinSet::new());
    for _ in 0..sizes.moves {
        let (at, client, seats, model, tag) =
            (registry.clone(), client.clone(), Arc::clone(&seats), model.clone(), tag.clone());
        tasks.spawn(async move {
            let _seat = seats.acquire().await?;
            at.swap(&client, &model, 1, &tag).await
        });
    }
    let mut winners = 0;
    while let Some(moved) = tasks.join_next().await {
        winners += usize::from(moved?? == Moved::Won);
    }
    let per_s = rate(sizes.moves, start.elapsed());
    Ok(vec![(label, winners.to_string()), ("the same: requests/s".to_owned(), per_s)])
}
