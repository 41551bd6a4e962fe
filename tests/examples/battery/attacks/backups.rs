//! `backups`: backups while writers write, restored into an empty place, and compared with the
//! ledger at the time.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use tokio::task::JoinSet;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::ledger::{Entry, Ledger, Shared};
use crate::place::Place;
use crate::writes::{FOR_ONE_SHIP, Write};

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

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let server = place.serve().await?;
    let shared = Arc::new(Shared::new(&field.tally));
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

async fn write(
    shared: Arc<Shared>,
    client: Client,
    number: u64,
    mut rng: rand_chacha::ChaCha12Rng,
) -> Result<(), Failure> {
    let Shared { ledger, tally, stop } = shared.as_ref();
    let (mut ship, mut writes) = (String::new(), Vec::new());
    for count in 0.. {
        if stop.load(Ordering::SeqCst) {
            break;
        }
        if count % FOR_ONE_SHIP == 0 {
            ship = format!("backed-{number}-{}", count / FOR_ONE_SHIP);
            writes = Write::first(&ship, number)?.into_iter().rev().collect();
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

/// A backup, restored: it has all that was acknowledged before it began, and nothing begun after it
/// ended.
async fn one(field: &Field, place: &Place, ledger: &Ledger, number: usize) -> Result<(), Failure> {
    let folder = place.folder().join(format!("backup-{number}"));
    let folder = folder.display().to_string();
    let before = ledger.entries().clone();
    field.tally.tried(1);
    let taken = place.command(&["backup", &folder]).await?;
    let all = ledger.entries().clone();
    let begun = all.len();
    if taken.status != Some(0) {
        field
            .tally
            .wrong(format!("a backup: status {:?}: {} {}", taken.status, taken.json, taken.errors));
        return Ok(());
    }
    let other = Place::new(field.database, Arc::clone(&field.tally)).await?;
    let restored = other.command(&["restore", &folder]).await?;
    if restored.status != Some(0) {
        field.tally.wrong(format!(
            "a restoration: status {:?}: {} {}",
            restored.status, restored.json, restored.errors
        ));
        return Ok(());
    }
    other.check("of a restored store").await?;
    let server = other.serve().await?;
    let known = Ledger::default();
    // What was sent while it was taken may be in it or not.
    let sent =
        all.into_iter().skip(before.len()).map(|entry| Entry { acknowledged: None, ..entry });
    known.entries().extend(before.into_iter().chain(sent));
    known.check(&server.client, &field.tally).await;
    let later = ledger.entries()[begun..].to_vec();
    none_of_later(field, &server.client, &later).await;
    server.process.kill();
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

/// What was begun after the end of the backup is not in it.
async fn none_of_later(field: &Field, client: &Client, later: &[Entry]) {
    let ships: BTreeSet<&str> = later.iter().map(|entry| entry.write.ship.as_str()).collect();
    for ship in ships {
        let trials = client.items(&format!("/v1/trials?ship={ship}")).await.unwrap_or_default();
        let there = |entry: &&Entry| {
            entry.write.ship == ship && trials.iter().any(|trial| trial["name"] == entry.write.mark)
        };
        for entry in later.iter().filter(there) {
            field
                .tally
                .wrong(format!("{} was begun after the backup, and is in it", entry.write.mark));
        }
    }
}
