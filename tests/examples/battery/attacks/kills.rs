//! `ledger`: writers keep a ledger while the server is killed at random moments, and ask again
//! under the same keys.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use rand::RngExt as _;
use rand_chacha::ChaCha12Rng;
use tokio::io::AsyncWriteExt as _;
use tokio::sync::watch;
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::faults::Control;
use crate::ledger::{Ledger, Shared};
use crate::place::Place;
use crate::process::Server;
use crate::tally::Tally;
use crate::writes::{FOR_ONE_SHIP, Write};

const WRITERS: u64 = 4;
/// Kills, however little time there is.
const FEWEST: i64 = 3;
/// Longer than a key is held for whoever carries it out.
const AHEAD_S: i64 = 61;

/// The attack.
pub struct Kills;

impl Attack for Kills {
    fn name(&self) -> &'static str {
        "ledger"
    }

    fn share(&self) -> f64 {
        2.0
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let control = Control::new(place.folder())?;
    let mut server = serve(field, &place, &control).await?;
    let shared = Arc::new(Shared::new(&field.tally));
    let (tell, told) = watch::channel(server.client.clone());
    let mut writers = JoinSet::new();
    for number in 0..WRITERS {
        writers.spawn(write(Arc::clone(&shared), told.clone(), number, field.rng(number)));
    }
    let (mut rng, mut kills) = (field.rng(WRITERS), 0);
    let until_check = field.left().mul_f64(0.75);
    let begun = std::time::Instant::now();
    while kills < FEWEST || begun.elapsed() < until_check {
        tokio::time::sleep(Duration::from_millis(rng.random_range(50..1000))).await;
        kills += 1;
        server.process.kill();
        control.ahead(AHEAD_S * kills)?;
        server = serve(field, &place, &control).await?;
        tell.send(server.client.clone())?;
    }
    shared.stop.store(true, Ordering::SeqCst);
    while let Some(written) = writers.join_next().await {
        written??;
    }
    shared.ledger.check(&server.client, &field.tally).await;
    leftovers(&place, server).await?;
    place.check("after the kills").await?;
    let acknowledged =
        shared.ledger.entries().iter().filter(|entry| entry.acknowledged.is_some()).count();
    field.tally.remark(format!("{kills} kills, {acknowledged} writes acknowledged"));
    Ok(())
}

/// A server whose clock can be put ahead, where that can be had.
async fn serve(field: &Field, place: &Place, control: &Control) -> Result<Server, Failure> {
    match &field.faults {
        Some(faults) => place.serve_under(faults, control).await,
        None => place.serve().await,
    }
}

/// One writer, on ships of its own.
async fn write(
    shared: Arc<Shared>,
    mut server: watch::Receiver<Client>,
    number: u64,
    mut rng: ChaCha12Rng,
) -> Result<(), Failure> {
    let Shared { ledger, tally, stop } = shared.as_ref();
    let mut ship = String::new();
    for count in 0.. {
        if stop.load(Ordering::SeqCst) {
            break;
        }
        if count % FOR_ONE_SHIP == 0 {
            ship = format!("writer-{number}-{}", count / FOR_ONE_SHIP);
            for write in &Write::first(&ship, number)? {
                until_known(ledger, ledger.begin(write), &mut server, tally).await;
            }
        }
        let client = server.borrow_and_update().clone();
        let write = Write::any(&client, &ship, count, &mut rng).await?;
        let place = ledger.begin(&write);
        until_known(ledger, place, &mut server, tally).await;
        // A key holds across kills, also where the answer came.
        if rng.random_bool(0.05) && write.key.is_some() {
            until_known(ledger, place, &mut server, tally).await;
        }
    }
    Ok(())
}

/// Sends a write; where no answer came, waits for the server to be there again and repeats it.
async fn until_known(
    ledger: &Ledger,
    place: usize,
    server: &mut watch::Receiver<Client>,
    tally: &Tally,
) {
    let client = server.borrow_and_update().clone();
    let mut known = ledger.send(place, &client, tally).await;
    while known.is_none() {
        if tokio::time::timeout(Duration::from_secs(60), server.changed()).await.is_err() {
            return tally.wrong("no answer from a server that was not killed");
        }
        let client = server.borrow_and_update().clone();
        known = ledger.repeat(place, &client, tally).await;
    }
}

/// A last kill in the middle of an upload: the next start, or the one after it, removes what was
/// received.
async fn leftovers(place: &Place, server: Server) -> Result<(), Failure> {
    let mut stream = tokio::net::TcpStream::connect(server.client.address).await?;
    let head = "POST /v1/trials?ship=writer-0-0&name=cut.csv HTTP/1.1\r\nhost: \
        localhost\r\ncontent-type: text/csv\r\ncontent-length: 10000000\r\n\r\nt_s,u_m_s\n";
    stream.write_all(head.as_bytes()).await?;
    stream.write_all("0.0,1.0\n".repeat(1000).as_bytes()).await?;
    let mut received = Vec::new();
    for _ in 0..100 {
        received = place.uploads_under_way();
        if !received.is_empty() {
            break;
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    server.process.kill();
    let server = place.serve().await?;
    tokio::time::sleep(Duration::from_millis(300)).await;
    server.process.kill();
    place.serve().await?.process.kill();
    let left: Vec<PathBuf> = place.uploads_under_way();
    if !left.is_empty() {
        place
            .tally
            .wrong(format!("files of uploads that a kill has cut stay after two starts: {left:?}"));
    }
    if received.is_empty() {
        place.tally.remark("no upload under way was seen in the data folder");
    }
    Ok(())
}
