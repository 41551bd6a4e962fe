//! `soak`: mixed load for the whole time, and lines fitted to memory, descriptors, log and
//! temporary files: their slopes.

use std::path::Path;
use std::time::{Duration, Instant};

use rand::RngExt as _;
use reqwest::Method;
use serde_json::json;
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::documents;

/// Interval of the samples.
const SAMPLING: Duration = Duration::from_millis(500);
/// Clients at a time.
const CLIENTS: u64 = 4;
/// Pause of a client between two requests, so that the load is the same on a slower machine.
const PAUSE: Duration = Duration::from_millis(100);
/// Part of the time after which samples count: caches fill before.
const WARM: f64 = 0.4;
/// Time from which a slope is judged: over a shorter one, the scatter of the allocator decides.
const JUDGED: Duration = Duration::from_secs(1800);
/// The largest slope of the memory, MB an hour.
const MOST_MB_PER_HOUR: f64 = 8.0;

/// The attack.
pub struct Soak;

impl Attack for Soak {
    fn name(&self) -> &'static str {
        "soak"
    }

    fn share(&self) -> f64 {
        2.0
    }

    fn works(&self) -> bool {
        true
    }

    fn least_minutes(&self) -> f64 {
        20.0
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

/// What a process has at one moment.
#[derive(Debug, Clone, Copy)]
struct Sample {
    hours: f64,
    memory_mb: f64,
    descriptors: f64,
    log_kb: f64,
    files: f64,
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let server = place.start().server().await?;
    let mut clients = JoinSet::new();
    for number in 0..CLIENTS {
        clients.spawn(load(server.client.clone(), number, field.rng(number), field.until));
    }
    let (begun, mut samples) = (Instant::now(), Vec::new());
    let time = field.left().max(Duration::from_secs(10));
    while begun.elapsed() < time {
        tokio::time::sleep(SAMPLING).await;
        samples.extend(sample(begun, server.process.id(), place.folder(), &place.data));
    }
    while let Some(done) = clients.join_next().await {
        done??;
    }
    let warm = samples.len() * (WARM * 100.0) as usize / 100;
    judge(field, &samples[warm..], time);
    server.process.kill();
    place.check("after the soak").await
}

/// Requests of every common kind, on ships of its own.
async fn load(
    client: Client,
    number: u64,
    mut rng: rand_chacha::ChaCha12Rng,
    until: Instant,
) -> Result<(), Failure> {
    let ship = format!("soaked-{number}");
    let made = client.request(Method::POST, "/v1/ships").header("content-type", "application/yaml");
    client.try_send(made.body(documents::ship(&ship))).await?;
    let turn = json!({ "model": documents::PATTERN, "manoeuvre": { "turn_deg": 20 } });
    for count in 0.. {
        if Instant::now() >= until {
            break;
        }
        let request = match rng.random_range(0..10) {
            0 => {
                let path = format!("/v1/trials?ship={ship}&name={count}.csv&diagnose=false");
                let request = client.request(Method::POST, &path);
                let row = number * 1_000_000 + count % 200;
                request.header("content-type", "text/csv").body(documents::rows(row))
            }
            1 => client.request(Method::POST, "/v1/predictions").json(&turn),
            2 => client.request(Method::GET, "/"),
            3 => client.request(Method::GET, &format!("/ships/{}", documents::PATTERN)),
            4 => client.request(Method::GET, "/metrics"),
            5 => client.request(Method::GET, &format!("/v1/ships/{}/similar", documents::PATTERN)),
            6 => client.request(Method::GET, &format!("/v1/ships/nothing-{count}")),
            7 => client.request(Method::GET, &format!("/v1/trials?ship={ship}")),
            8 => client.request(Method::POST, "/v1/sessions").json(&json!({ "model": "nothing" })),
            _ => client.request(Method::GET, &format!("/v1/ships/{}/model", documents::PATTERN)),
        };
        client.send(request).await;
        tokio::time::sleep(PAUSE).await;
    }
    Ok(())
}

/// One sample; none where the process cannot be read.
fn sample(begun: Instant, id: u32, folder: &Path, data: &Path) -> Option<Sample> {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kb: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    let log = std::fs::metadata(folder.join("log")).map_or(0, |file| file.len());
    Some(Sample {
        hours: begun.elapsed().as_secs_f64() / 3600.0,
        memory_mb: kb / 1024.0,
        descriptors: std::fs::read_dir(format!("/proc/{id}/fd")).ok()?.count() as f64,
        log_kb: log as f64 / 1000.0,
        files: files_below(&data.join("uploads")) as f64,
    })
}

fn files_below(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| if entry.path().is_dir() { files_below(&entry.path()) } else { 1 }).sum()
}

/// Least squares: slope per hour, and its standard error.
fn slope(samples: &[Sample], of: fn(&Sample) -> f64) -> (f64, f64) {
    let count = samples.len() as f64;
    let mean = |value: &dyn Fn(&Sample) -> f64| samples.iter().map(value).sum::<f64>() / count;
    let (time, level) = (mean(&|sample| sample.hours), mean(&|sample| of(sample)));
    let spread: f64 = samples.iter().map(|sample| (sample.hours - time).powi(2)).sum();
    let joint: f64 =
        samples.iter().map(|sample| (sample.hours - time) * (of(sample) - level)).sum();
    let slope = joint / spread;
    let left: f64 = samples
        .iter()
        .map(|sample| (of(sample) - level - slope * (sample.hours - time)).powi(2))
        .sum();
    (slope, (left / (count - 2.0).max(1.0) / spread).sqrt())
}

fn judge(field: &Field, samples: &[Sample], time: Duration) {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return };
    let (memory, error) = slope(samples, |sample| sample.memory_mb);
    let (descriptors, _) = slope(samples, |sample| sample.descriptors);
    let (log, _) = slope(samples, |sample| sample.log_kb);
    let (files, _) = slope(samples, |sample| sample.files);
    field.tally.remark(format!(
        "memory {:.0} to {:.0} MB, {memory:+.1}±{error:.1} MB/h; descriptors {descriptors:+.1}/h; \
         log {log:+.0} kB/h; temporary files {files:+.1}/h",
        first.memory_mb, last.memory_mb
    ));
    if time >= JUDGED && memory - 2.0 * error > MOST_MB_PER_HOUR {
        field.tally.wrong(format!("the memory grows by {memory:.1} MB an hour"));
    }
}
