//! Geographic positions of ships: that of the newest trial that has one.

use serde::Deserialize;
use sistership_store::{FactRange, PageRequest, ShipSearch, StoreError};
use sistership_trials::GeographicPosition;

use super::urgency::{FLEET_FACT, UrgencyClass};
use crate::archive::Archive;
use crate::error::DeriveError;
use crate::ship_trials::newest_trials;

/// Facts with the position, deg.
const LATITUDE_FACT: &str = "position latitude";
const LONGITUDE_FACT: &str = "position longitude";

/// Ship of the fleet with its last known position.
#[derive(Debug, Clone, PartialEq)]
pub struct ShipPosition {
    /// Name of the ship.
    pub ship: String,
    /// Display title.
    pub title: String,
    /// Class of its condition.
    pub class: UrgencyClass,
    /// Position of its newest trial that has one.
    pub position: GeographicPosition,
}

/// Part of a stored manifest with the position.
#[derive(Deserialize)]
struct PlacedManifest {
    origin: Option<GeographicPosition>,
}

/// Computes the facts of a ship; none if no trial has a position.
pub(super) async fn position_facts(
    archive: &Archive,
    ship: &str,
) -> Result<Vec<(String, f64)>, StoreError> {
    let position = |manifest: &str| {
        serde_json::from_str::<PlacedManifest>(manifest).ok().and_then(|placed| placed.origin)
    };
    // Later trials without fixes do not remove a ship from the map.
    let is_placed = |trial: &sistership_store::Trial| position(&trial.manifest).is_some();
    let newest = newest_trials(&archive.store, ship, 1, is_placed).await?;
    Ok(match newest.first().and_then(|trial| position(&trial.manifest)) {
        Some(GeographicPosition { latitude_deg, longitude_deg }) => vec![
            (LATITUDE_FACT.to_owned(), latitude_deg),
            (LONGITUDE_FACT.to_owned(), longitude_deg),
        ],
        None => Vec::new(),
    })
}

/// Returns the ships of the fleet that have a position, the most urgent first, at most `most`.
///
/// # Errors
/// Returns an error if the store fails.
pub async fn fleet_positions(
    archive: &Archive,
    most: i64,
) -> Result<Vec<ShipPosition>, DeriveError> {
    // Ships of the library have no place of their own.
    let fleet = FactRange { fact: FLEET_FACT.to_owned(), ..UrgencyClass::full_range() };
    let search = ShipSearch { ranges: vec![fleet, placed_range()], ..ShipSearch::default() };
    let page = PageRequest { after: None, limit: most };
    let ships = archive.store.ships().search_ships(&search, &page).await?.items;
    let names: Vec<String> = ships.iter().map(|ship| ship.name.clone()).collect();
    // Two queries for all ships, not two for each.
    let latitudes = archive.store.fact_values(&names, LATITUDE_FACT).await?;
    let longitudes = archive.store.fact_values(&names, LONGITUDE_FACT).await?;
    let placed = ships.into_iter().filter_map(|ship| {
        Some(ShipPosition {
            class: UrgencyClass::from_order(ship.value?),
            position: GeographicPosition {
                latitude_deg: *latitudes.get(&ship.name)?,
                longitude_deg: *longitudes.get(&ship.name)?,
            },
            ship: ship.name,
            title: ship.title,
        })
    });
    Ok(placed.collect())
}

/// Returns the number of ships that have a position.
///
/// # Errors
/// Returns an error if the store fails.
pub async fn count_positions(archive: &Archive) -> Result<i64, DeriveError> {
    Ok(archive.store.ships().count_ships(&placed_range()).await?)
}

fn placed_range() -> FactRange {
    FactRange { fact: LATITUDE_FACT.to_owned(), min: -90.0, max: 90.0 }
}
