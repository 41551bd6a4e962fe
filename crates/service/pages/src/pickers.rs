//! Names that fields for a model offer while one types, and the model to begin with.

use sistership_jobs::Archive;
use sistership_jobs::aliases::{CHAMPION, find_alias};
use sistership_jobs::search::urgency::{FLEET_FACT, UrgencyClass};
use sistership_store::{FactRange, PageRequest, ShipSearch};

use crate::error::Result;

/// Largest number of offered names.
const MOST_NAMES: i64 = 100;
/// Ships of the fleet among which one with a model is looked for.
const FIRST_SHIPS: i64 = 10;
/// Published ship that is shown where the fleet has no model.
const EXAMPLE_SHIP: &str = "mariner";

/// Returns the names of the fleet and, as far as there is room, of the other ships.
///
/// # Errors
/// Returns an error if the store fails.
pub(crate) async fn model_names(archive: &Archive) -> Result<Vec<String>> {
    let mut names = fleet_names(archive, MOST_NAMES).await?;
    let page = PageRequest { after: None, limit: MOST_NAMES };
    let others = archive.store.ships().search_ships(&ShipSearch::default(), &page).await?;
    let room = MOST_NAMES as usize;
    for ship in others.items {
        if names.len() < room && !names.contains(&ship.name) {
            names.push(ship.name);
        }
    }
    Ok(names)
}

/// Returns the ship of the fleet that most needs attention and has a model, else a published one.
///
/// # Errors
/// Returns an error if the store fails.
pub(crate) async fn first_model(archive: &Archive) -> Result<String> {
    for name in fleet_names(archive, FIRST_SHIPS).await? {
        if find_alias(&archive.store, &name, CHAMPION).await?.is_some() {
            return Ok(name);
        }
    }
    Ok(EXAMPLE_SHIP.to_owned())
}

async fn fleet_names(archive: &Archive, limit: i64) -> Result<Vec<String>> {
    let all = FactRange { fact: FLEET_FACT.to_owned(), ..UrgencyClass::full_range() };
    let search = ShipSearch { ranges: vec![all], ..ShipSearch::default() };
    let page = PageRequest { after: None, limit };
    let found = archive.store.ships().search_ships(&search, &page).await?;
    Ok(found.items.into_iter().map(|ship| ship.name).collect())
}
