//! `upgrades`: stores as each earlier migration left them, with rows, are opened by the program of
//! today.

use std::path::Path;

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::ledger::Ledger;
use crate::place::Place;
use crate::tally::Tally;
use crate::writes::Write;

const SHIP: &str = "upgraded";

/// The attack.
pub struct Upgrades;

impl Attack for Upgrades {
    fn name(&self) -> &'static str {
        "upgrades"
    }

    fn share(&self) -> f64 {
        0.5
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let today = field.place().await?;
    let server = today.serve().await?;
    let ledger = filled(&server.client, &field.tally).await?;
    server.process.kill();
    let migrations = sistership_store::testing::migration_numbers();
    for &migration in &migrations {
        field.tally.tried(1);
        let earlier = field.database.empty().await?.migrate_to(migration).await;
        earlier.fill_from(&today.database).await;
        let place = Place::of(earlier, std::sync::Arc::clone(&field.tally));
        copy(&today.data, &place.data)?;
        one(&place, &ledger, migration)
            .await
            .map_err(|error| format!("from migration {migration}: {error}"))?;
    }
    field.tally.remark(format!("from migrations {migrations:?}"));
    Ok(())
}

/// A store of today with something of every kind that the first migration knew.
async fn filled(client: &Client, tally: &Tally) -> Result<Ledger, Failure> {
    let ledger = Ledger::default();
    let mut writes = vec![
        Write::ship(SHIP),
        Write::version(SHIP, "the first")?,
        Write::law(SHIP, "upgraded-law"),
    ];
    writes.extend((0..5).map(|number| Write::trial(SHIP, &format!("trial-{number}"), number)));
    writes.extend([Write::alias(SHIP, "an alias", 1, None), Write::version(SHIP, "the second")?]);
    for write in &writes {
        if ledger.send(ledger.begin(write), client, tally).await != Some(true) {
            return Err(format!("{:?} is not taken", write.kind).into());
        }
    }
    Ok(ledger)
}

/// Everything is there and can be read, the store is clean, and it takes more.
async fn one(place: &Place, ledger: &Ledger, migration: i64) -> Result<(), Failure> {
    let server = place.serve().await?;
    ledger.check(&server.client, &place.tally).await;
    let more = Ledger::default();
    for write in
        [Write::tag(SHIP, "opened"), Write::trial(SHIP, "later", 100), Write::ship("later")]
    {
        if more.send(more.begin(&write), &server.client, &place.tally).await != Some(true) {
            place.tally.wrong(format!("from migration {migration}: {:?} is not taken", write.kind));
        }
    }
    place.check(&format!("from migration {migration}, served")).await?;
    let verified = place.command(&["verify", &format!("{SHIP}/1")]).await?;
    if verified.json["identical"] != true {
        place.tally.wrong(format!(
            "from migration {migration}: verify: {} {}",
            verified.json, verified.errors
        ));
    }
    server.process.kill();
    place.check(&format!("from migration {migration}")).await
}

/// Copies a folder with all that is in it.
fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(to)?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        match entry.file_type()?.is_dir() {
            true => copy(&entry.path(), &target)?,
            false => std::fs::copy(entry.path(), target).map(drop)?,
        }
    }
    Ok(())
}
