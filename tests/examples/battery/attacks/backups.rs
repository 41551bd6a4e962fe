//! `backups`: backups while writers write, restored into an empty place, and compared with the ledger at the time.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::Value;
use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::ledger::Ledger;
use crate::place::Place;
use crate::tally::Tally;
use crate::writes::Write;

const WRITERS: u64 = 2;

/// The attack.
pub struct Backups;

impl Attack for Backups {
    fn name(&self) -> &'static str {
        "backups"
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

/// What writers share.
struct Shared {
    ledger: Ledger,
    tally: Arc<Tally>,
    stop: AtomicBool,
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let server = place.serve().await?;
    let shared = Arc::new(Shared { ledger: Ledger::default(), tally: Arc::clone(&field.tally), stop: AtomicBool::new(false) });
    let mut writers = JoinSet::new();
    for number in 0..WRITERS {
        writers.spawn(write(Arc::clone(&shared), server.client.clone(), number, field.rng(number)));
    }
    tokio::time::sleep(std::time::Duration::from_millis(500)).await;
    let mut backups = 0;
    while backups == 0 || field.goes_on() {
        backups += 1;
        one(field, &place, &shared.ledger, backups).await?;
    }
    shared.stop.store(true, Ordering::SeqCst);
    while let Some(written) = writers.join_next().await {
        written??;
    }
    server.process.kill();
    place.check("after the backups").await?;
    field.tally.remark(format!("{backups} backups"));
    Ok(())
}

async fn write(shared: Arc<Shared>, client: Client, number: u64, mut rng: rand_chacha::ChaCha12Rng) -> Result<(), Failure> {
    let Shared { ledger, tally, stop } = shared.as_ref();
    let ship = format!("backed-{number}");
    let mut writes = vec![Write::trial(&ship, "the-first", number), Write::version(&ship, "the first")?, Write::ship(&ship)];
    for count in 0.. {
        if stop.load(Ordering::SeqCst) {
            break;
        }
        let write = match writes.pop() {
            Some(write) => write,
            None => Write::any(&client, &ship, count, &mut rng).await?,
        };
        if ledger.send(ledger.begin(&write), &client, tally).await.is_none() {
            tally.wrong("no answer from a server that was not killed");
        }
    }
    Ok(())
}

/// A backup, restored: it has all that was acknowledged before it began, and nothing begun after it ended.
async fn one(field: &Field, place: &Place, ledger: &Ledger, number: usize) -> Result<(), Failure> {
    let folder = place.folder().join(format!("backup-{number}"));
    let folder = folder.display().to_string();
    let before: Vec<_> = ledger.entries().iter().filter(|entry| entry.acknowledged.is_some()).cloned().collect();
    field.tally.tried(1);
    let taken = place.command(&["backup", &folder]).await?;
    let begun = ledger.entries().len();
    if taken.status != Some(0) {
        field.tally.wrong(format!("a backup: status {:?}: {} {}", taken.status, taken.json, taken.errors));
        return Ok(());
    }
    let other = Place::new(field.database, Arc::clone(&field.tally)).await?;
    let restored = other.command(&["restore", &folder]).await?;
    if restored.status != Some(0) {
        field.tally.wrong(format!("a restoration: status {:?}: {} {}", restored.status, restored.json, restored.errors));
        return Ok(());
    }
    other.check("of a restored store").await?;
    let server = other.serve().await?;
    let known = Ledger::default();
    known.entries().extend(before);
    known.check(&server.client, &field.tally).await;
    let later = ledger.entries()[begun..].to_vec();
    none_of_later(field, &server.client, &later).await;
    server.process.kill();
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

/// What was begun after the end of the backup is not in it.
async fn none_of_later(field: &Field, client: &Client, later: &[crate::ledger::Entry]) {
    for number in 0..WRITERS {
        let trials = client.items(&format!("/v1/trials?ship=backed-{number}")).await.unwrap_or_default();
        let there = |mark: &str| trials.iter().any(|trial: &Value| trial["name"] == mark);
        for entry in later.iter().filter(|entry| there(&entry.write.mark)) {
            field.tally.wrong(format!("{} was begun after the backup, and is in it", entry.write.mark));
        }
    }
}
