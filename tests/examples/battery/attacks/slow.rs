//! `slow`: connections that send a head, a body or nothing at all by the drop, and such that never
//! read their answers. Beside them, how long a new connection waits for `/v1/ships`.

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use reqwest::Method;
use tokio::io::AsyncWriteExt as _;
use tokio::net::{TcpSocket, TcpStream};
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::process::Server;

/// Connections of each kind.
const CROWD: usize = 600;
/// What a new connection may wait, 99 of 100 times. A build without optimisation on busy cores took
/// up to 0.5 s: it may take four times as long.
const P99_MS: f64 = if cfg!(debug_assertions) { 2000.0 } else { 50.0 };
/// A new connection that waits longer is shut out.
const SHUT_OUT: Duration = Duration::from_secs(5);
/// From SIGTERM to the end: what connections get (10 s), and a little.
const STOPPING: Duration = Duration::from_secs(15);

/// The attack.
pub struct Slow;

impl Attack for Slow {
    fn name(&self) -> &'static str {
        "slow"
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

/// What a connection does.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Idle,
    HalfHead,
    StalledBody,
    StalledUpload,
    Unread,
}

const KINDS: [Kind; 5] =
    [Kind::Idle, Kind::HalfHead, Kind::StalledBody, Kind::StalledUpload, Kind::Unread];

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let mut server = place.serve().await?;
    let each = field.left().mul_f64(0.8) / (KINDS.len() as u32 + 1);
    let mut worst = Vec::new();
    for kind in KINDS {
        let crowd = crowd(kind, server.client.address).await;
        field.tally.tried(crowd.len() as u64);
        worst.push(measured(field, &server, &format!("{kind:?}"), each).await);
        drop(crowd);
        server.lives(&format!("{kind:?} connections")).await?;
    }
    let mut both = crowd(Kind::StalledBody, server.client.address).await;
    both.extend(crowd(Kind::Unread, server.client.address).await);
    worst.push(measured(field, &server, "StalledBody and Unread", each).await);
    if !server.process.terminate(STOPPING).await {
        field.tally.wrong(format!(
            "SIGTERM beside {} slow connections: no good end within {STOPPING:?}",
            both.len()
        ));
    }
    let words: Vec<String> = worst.iter().map(|ms| format!("{ms:.0}")).collect();
    field.tally.remark(format!("p99 of a new connection {} ms", words.join("/")));
    Ok(())
}

/// Connections of one kind, all from another address than that of the measurements.
async fn crowd(kind: Kind, address: SocketAddr) -> Vec<TcpStream> {
    let mut opening: JoinSet<std::io::Result<TcpStream>> =
        (0..CROWD).map(|_| one(kind, address)).collect();
    let mut crowd = Vec::new();
    while let Some(opened) = opening.join_next().await {
        if let Ok(Ok(stream)) = opened {
            crowd.push(stream);
        }
    }
    crowd
}

async fn one(kind: Kind, address: SocketAddr) -> std::io::Result<TcpStream> {
    let socket = TcpSocket::new_v4()?;
    socket.set_recv_buffer_size(4096)?;
    socket.bind(([127, 0, 0, 2], 0).into())?;
    let connecting = tokio::time::timeout(Duration::from_secs(2), socket.connect(address));
    let mut stream = connecting.await.map_err(|_| std::io::ErrorKind::TimedOut)??;
    let said = words(kind);
    // What is not taken now is not needed: the other side is to wait, not this one.
    let _ = tokio::time::timeout(Duration::from_secs(1), stream.write_all(said.as_bytes())).await;
    Ok(stream)
}

fn words(kind: Kind) -> String {
    let body = |path: &str, media: &str| {
        format!(
            "POST {path} HTTP/1.1\r\nhost: localhost\r\ncontent-type: {media}\r\ncontent-length: \
             1000000\r\n\r\nt_s,u_m_s\n"
        )
    };
    match kind {
        Kind::Idle => String::new(),
        Kind::HalfHead => "GET /v1/ships HTTP/1.1\r\nhost: localhost\r\nx-slow: ".to_owned(),
        Kind::StalledBody => body("/v1/laws", "application/yaml"),
        Kind::StalledUpload => body("/v1/trials/check?ship=slow&name=slow.csv", "text/csv"),
        Kind::Unread => "GET /v1/laws/abkowitz HTTP/1.1\r\nhost: localhost\r\n\r\n".repeat(400),
    }
}

/// The 99th percentile of what a new connection waits for `/v1/ships`, ms.
async fn measured(field: &Field, server: &Server, beside: &str, time: Duration) -> f64 {
    let (begun, mut waited, mut shut_out) = (Instant::now(), Vec::new(), 0);
    while waited.len() < 20 || begun.elapsed() < time {
        let asked = Instant::now();
        let request = server.client.request(Method::GET, "/v1/ships").timeout(SHUT_OUT);
        let answered = server.client.send(request).await.is_some_and(|reply| reply.ok());
        waited.push(asked.elapsed().as_secs_f64() * 1e3);
        shut_out += usize::from(!answered);
        if shut_out > 2 {
            break;
        }
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
    waited.sort_by(f64::total_cmp);
    let p99 = waited[(waited.len() * 99).div_ceil(100) - 1];
    if shut_out > 0 {
        field.tally.wrong(format!(
            "beside {CROWD} connections ({beside}) {shut_out} of {} new ones were shut out",
            waited.len()
        ));
    } else if p99 > P99_MS {
        field.tally.wrong(format!(
            "beside {CROWD} connections ({beside}) a new one waits {p99:.0} ms (p99), not {P99_MS}"
        ));
    }
    p99
}
