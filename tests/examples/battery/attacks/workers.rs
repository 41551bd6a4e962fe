//! `workers`: worker processes are killed in the middle of jobs, and a job that kills every worker
//! is set aside.

use std::time::{Duration, Instant};

use rand::RngExt as _;
use reqwest::Method;
use reqwest::multipart::{Form, Part};
use serde_json::{Value, json};

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::documents;
use crate::place::Place;
use crate::process::Process;

/// The ship that is refined.
pub(super) const SHIP: &str = "worked";
const WORKERS: usize = 2;
const PATIENCE: Duration = Duration::from_secs(120);
/// A job that ends its process this often is set aside.
const DEATHS: usize = 2;

/// The attack.
pub struct Workers;

impl Attack for Workers {
    fn name(&self) -> &'static str {
        "workers"
    }

    fn share(&self) -> f64 {
        2.0
    }

    fn works(&self) -> bool {
        true
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let server = place.serve().await?;
    let client = server.client.clone();
    prepare(&client).await?;
    let (jobs, kills) = once(field, &place, &client).await?;
    set_aside(field, &place, &client).await?;
    too_deep(field, &place, &client).await?;
    server.process.kill();
    place.check("after the kills of workers").await?;
    field.tally.remark(format!("{jobs} jobs, {kills} workers killed in the middle of one"));
    Ok(())
}

/// A ship with trials.
pub(super) async fn prepare(client: &Client) -> Result<(), Failure> {
    let ship = client.request(Method::POST, "/v1/ships").header("content-type", "application/yaml");
    let made = client.try_send(ship.body(documents::ship(SHIP))).await?;
    let trials = documents::trials()?;
    let entry = |name: &String| json!({ "file": name });
    let entries: Vec<Value> = trials.iter().map(|(name, _)| entry(name)).collect();
    let form = Form::new()
        .text("manifest", json!({ "kind": "trials", "ship": SHIP, "trials": entries }).to_string());
    let form = trials
        .into_iter()
        .fold(form, |form, (name, csv)| form.part("file", Part::bytes(csv).file_name(name)));
    let sent = client.try_send(client.request(Method::POST, "/v1/trials").multipart(form)).await?;
    match made.ok() && sent.ok() {
        true => Ok(()),
        false => Err(format!("no ship to work on: {} {}", made.json(), sent.json()).into()),
    }
}

/// Queues a refinement; gives its id.
async fn refine(client: &Client, more: &[(&str, &str)]) -> Result<String, Failure> {
    let mut body = json!({ "ship": SHIP, "source": documents::PATTERN });
    more.iter().for_each(|(field, value)| body[*field] = json!(value));
    let reply =
        client.try_send(client.request(Method::POST, "/v1/refinements").json(&body)).await?;
    let said = reply.json();
    said["id"].as_str().map(str::to_owned).ok_or_else(|| format!("no job: {said}").into())
}

async fn worker(place: &Place) -> Result<Process, Failure> {
    place.start().argument("--lease-s").argument("1").worker().await
}

/// Every job is done once, whoever dies.
async fn once(field: &Field, place: &Place, client: &Client) -> Result<(usize, usize), Failure> {
    let (mut rng, mut jobs, mut kills) = (field.rng(0), 0, 0);
    let until = Instant::now() + field.left().mul_f64(0.6);
    while jobs == 0 || Instant::now() < until {
        let queued = 3;
        for _ in 0..queued {
            refine(client, &[]).await?;
        }
        jobs += queued;
        let mut workers = Vec::new();
        for _ in 0..WORKERS {
            workers.push(worker(place).await?);
        }
        for _ in 0..2 {
            tokio::time::sleep(Duration::from_millis(rng.random_range(0..400))).await;
            kills += kill_one(client, &mut workers).await;
            workers.push(worker(place).await?);
        }
        finished(client, PATIENCE).await?;
        workers.into_iter().for_each(Process::kill);
    }
    judge_versions(field, client, &all_jobs(client).await).await;
    Ok((jobs, kills))
}

/// Every job has succeeded, each by one version of its own.
pub(super) async fn judge_versions(field: &Field, client: &Client, jobs: &[Value]) {
    let versions = client.items(&format!("/v1/models/{SHIP}/versions")).await.unwrap_or_default();
    let done = jobs.iter().filter(|job| job["state"] == "succeeded");
    let mut made: Vec<u64> = done.filter_map(|job| job["result"]["version"].as_u64()).collect();
    made.sort_unstable();
    if versions.len() != made.len() || !made.iter().copied().eq(1..=made.len() as u64) {
        field.tally.wrong(format!("{} versions came of jobs that name {made:?}", versions.len()));
    }
    for job in jobs.iter().filter(|job| job["state"] != "succeeded") {
        field.tally.wrong(format!("a job of which no worker was to blame: {job}"));
    }
}

/// Kills a worker that holds a job, if one does and no running job has lost one yet; gives how many.
async fn kill_one(client: &Client, workers: &mut Vec<Process>) -> usize {
    let jobs = all_jobs(client).await;
    let mut running = jobs.iter().filter(|job| job["state"] == "running").peekable();
    // A job that loses its second worker is set aside, as it should be.
    let held = running.peek().is_some() && running.all(|job| job["attempt"] == 1);
    // Which of them holds it is not told over HTTP: with all of them dead, one that does is.
    let victims = if held { workers.len() } else { 1 };
    workers.drain(..victims).for_each(Process::kill);
    usize::from(held)
}

/// All jobs of the ship.
pub(super) async fn all_jobs(client: &Client) -> Vec<Value> {
    client.items(&format!("/v1/jobs?ship={SHIP}")).await.unwrap_or_default()
}

/// Number of jobs of the ship that wait or run.
pub(super) async fn unfinished(client: &Client) -> usize {
    let pending = |job: &&Value| job["state"] == "queued" || job["state"] == "running";
    all_jobs(client).await.iter().filter(pending).count()
}

/// Waits until all jobs of the ship have ended.
pub(super) async fn finished(client: &Client, patience: Duration) -> Result<(), Failure> {
    let begun = Instant::now();
    while unfinished(client).await > 0 {
        if begun.elapsed() > patience {
            let waiting = unfinished(client).await;
            return Err(format!("{waiting} jobs do not end within {patience:?}").into());
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    Ok(())
}

/// A job whose worker dies each time it begins is failed, and not begun again.
async fn set_aside(field: &Field, place: &Place, client: &Client) -> Result<(), Failure> {
    let job = refine(client, &[]).await?;
    let path = format!("/v1/jobs/{job}");
    let mut deaths = 0;
    while deaths < 6 {
        let worker = worker(place).await?;
        let state = begun(client, &path, deaths).await?;
        worker.kill();
        if state["state"] != "running" {
            break;
        }
        deaths += 1;
    }
    if deaths != DEATHS {
        field.tally.wrong(format!(
            "a job that ends its process was begun {deaths} times, not \
            {DEATHS}, until it was set aside"
        ));
    }
    Ok(())
}

/// Waits until a job is begun once more, or has ended.
async fn begun(client: &Client, path: &str, times: usize) -> Result<Value, Failure> {
    let begun = Instant::now();
    loop {
        let job = client.get(path).await;
        let again = job["state"] == "running" && job["attempt"].as_u64() > Some(times as u64);
        if again || matches!(job["state"].as_str(), Some("failed" | "succeeded" | "cancelled")) {
            return Ok(job);
        }
        if begun.elapsed() > PATIENCE {
            return Err(format!("a job is neither begun nor ended: {job}").into());
        }
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
}

/// A law that is accepted does not end a worker, however long it is.
async fn too_deep(field: &Field, place: &Place, client: &Client) -> Result<(), Failure> {
    let terms = "sqrt(u_A^2 + v_A^2 + 1e-6)".to_owned() + &" + 0*u_A^2".repeat(3300);
    let law = documents::low_speed_law("very-long", &terms);
    let request =
        client.request(Method::POST, "/v1/laws").header("content-type", "application/yaml");
    if !client.try_send(request.body(law)).await?.ok() {
        return Ok(());
    }
    let job = refine(client, &[("law", "very-long"), ("source", "kvlcc2")]).await;
    let Ok(job) = job else { return Ok(()) };
    let mut worker = worker(place).await?;
    let path = format!("/v1/jobs/{job}");
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE && !worker.ended() {
        let state = client.get(&path).await;
        if matches!(state["state"].as_str(), Some("failed" | "succeeded" | "cancelled")) {
            worker.kill();
            return Ok(());
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    match worker.ended() {
        // Dropping it counts.
        true => drop(worker),
        false => field.tally.wrong("a refinement by a law of 3,300 terms does not end"),
    }
    Ok(())
}
