//! `memory`: requests that are small to send and large to hold, many at once, and downloads that
//! nobody reads.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use reqwest::Method;
use sistership_model::trial::{Channel, Trial};
use sistership_trials::samples::to_parquet;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::{Client, Reply};
use crate::documents;
use crate::process::Server;

/// Rows of the file that is checked, and of the one that is downloaded.
const ROWS: usize = 4_900_000;
const KEPT_ROWS: usize = 1_500_000;
const DOCUMENT_BYTES: usize = 4_000_000;
const UPLOADS: usize = 8;
const DOCUMENTS: usize = 16;
const DOWNLOADS: usize = 6;
const SHIP: &str = "heavy";
/// What another request may wait meanwhile.
const MEANWHILE: Duration = Duration::from_secs(5);

/// The attack.
pub struct Memory;

impl Attack for Memory {
    fn name(&self) -> &'static str {
        "memory"
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let mut server = place.serve().await?;
    let ship =
        server.client.request(Method::POST, "/v1/ships").header("content-type", "application/yaml");
    server.client.try_send(ship.body(documents::ship(SHIP))).await?;
    let (mut rounds, mut said) = (0, Vec::new());
    while rounds == 0 || field.goes_on() {
        rounds += 1;
        for step in ["documents", "Parquet", "downloads"] {
            let statuses = match step {
                "documents" => together(field, &server.client, &documents_of_size(rounds)).await,
                "Parquet" => together(field, &server.client, &uploads()?).await,
                _ => downloads(field, &server, rounds).await?,
            };
            said.push(format!("{step} {} MB ({statuses})", server.process.peak_mb()));
            if server.lives(&format!("large {step}")).await? {
                // Each step by itself: what was once resident may stay so.
                server.restart().await?;
            }
        }
    }
    said.truncate(3);
    server.process.kill();
    place.check("after the large requests").await?;
    field.tally.remark(said.join(", "));
    Ok(())
}

/// A request to be repeated: its path, its media type, its body.
type Heavy = (&'static str, &'static str, Vec<u8>, usize);

/// YAML of many small values, of deep nesting within what a parser takes, and of many terms.
fn documents_of_size(round: usize) -> Heavy {
    let line = match round % 3 {
        1 => "- [1, 2, 3, 4, 5, 6, 7, 8, 9]\n",
        2 => "- {a: {b: {c: {d: e}}}}\n",
        _ => "- x\n",
    };
    let text =
        format!("kind: law\nname: heavy\nvalues:\n{}", line.repeat(DOCUMENT_BYTES / line.len()));
    ("/v1/laws", "application/yaml", text.into_bytes(), DOCUMENTS)
}

fn uploads() -> Result<Heavy, Failure> {
    static FILE: OnceLock<Vec<u8>> = OnceLock::new();
    let path = "/v1/trials/check?ship=heavy&name=heavy.parquet";
    Ok((path, "application/vnd.apache.parquet", constants(&FILE, ROWS)?, UPLOADS))
}

/// A trial of constants: long, and small when compressed.
fn constants(kept: &OnceLock<Vec<u8>>, rows: usize) -> Result<Vec<u8>, Failure> {
    if let Some(bytes) = kept.get() {
        return Ok(bytes.clone());
    }
    let channels: BTreeMap<Channel, Vec<f64>> =
        [Channel::U, Channel::V, Channel::R, Channel::Delta]
            .map(|channel| (channel, vec![0.0; rows]))
            .into();
    let t_s = (0..rows).map(|row| row as f64).collect();
    let trial = Trial { name: "heavy".to_owned(), t_s, channels, ..Trial::default() };
    let bytes = to_parquet(&trial).map_err(|error| error.to_string())?;
    Ok(kept.get_or_init(|| bytes).clone())
}

/// Sends the same so many times at once, and looks whether others are answered meanwhile; gives the
/// statuses.
async fn together(field: &Field, client: &Client, (path, media, body, count): &Heavy) -> String {
    let mut sending: JoinSet<Option<Reply>> = (0..*count)
        .map(|_| {
            let request = client
                .request(Method::POST, path)
                .header("content-type", *media)
                .body(body.clone());
            let (client, request) = (client.clone(), request.timeout(Duration::from_secs(120)));
            async move { client.send(request).await }
        })
        .collect();
    let asked = Instant::now();
    let other = client.request(Method::GET, "/v1/ships").timeout(4 * MEANWHILE);
    if client.send(other).await.is_none() || asked.elapsed() > MEANWHILE {
        field.tally.wrong(format!(
            "/v1/ships waits {:.1} s beside {count} of {path}",
            asked.elapsed().as_secs_f64()
        ));
    }
    let mut statuses = BTreeMap::new();
    while let Some(reply) = sending.join_next().await {
        let status = reply.ok().flatten().map_or(0, |reply| reply.status);
        *statuses.entry(status).or_insert(0) += 1;
    }
    let unanswered = statuses.get(&0).copied().unwrap_or(0);
    if unanswered > 0 {
        field.tally.wrong(format!("{unanswered} of {count} requests to {path} get no answer"));
    }
    statuses.iter().map(|(status, count)| format!("{status}×{count}")).collect::<Vec<_>>().join(" ")
}

/// Downloads of a long trial that are begun and not read.
async fn downloads(field: &Field, server: &Server, round: usize) -> Result<String, Failure> {
    static FILE: OnceLock<Vec<u8>> = OnceLock::new();
    let mut rows = KEPT_ROWS;
    let id = loop {
        let body = if rows == KEPT_ROWS {
            constants(&FILE, rows)?
        } else {
            constants(&OnceLock::new(), rows)?
        };
        let path = format!("/v1/trials?ship={SHIP}&name=long-{round}.parquet&diagnose=false");
        let request = server
            .client
            .request(Method::POST, &path)
            .header("content-type", "application/vnd.apache.parquet");
        let reply = server.client.send(request.timeout(Duration::from_secs(120)).body(body)).await;
        match reply.map(|reply| reply.json()["trials"][0]["id"].as_str().map(str::to_owned)) {
            Some(Some(id)) => break id,
            _ if rows > 10_000 => rows /= 4,
            _ => return Err("no long trial is taken".into()),
        }
    };
    let head = format!(
        "GET /v1/trials/{id}/samples HTTP/1.1\r\nhost: localhost\r\naccept: text/csv\r\n\r\n"
    );
    let mut held: Vec<TcpStream> = Vec::new();
    for _ in 0..DOWNLOADS {
        let socket = TcpSocket::new_v4()?;
        socket.set_recv_buffer_size(4096)?;
        let mut stream = socket.connect(server.client.address).await?;
        stream.write_all(head.as_bytes()).await?;
        let mut first = [0; 16];
        let _ = tokio::time::timeout(Duration::from_secs(20), stream.read(&mut first)).await;
        held.push(stream);
    }
    field.tally.tried(DOWNLOADS as u64);
    tokio::time::sleep(Duration::from_millis(500)).await;
    Ok(format!("of {rows} rows"))
}
