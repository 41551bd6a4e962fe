//! Search for ships: by category, tag, particulars, metrics of the champion, and similarity to a
//! ship.

mod facts;
mod index;
mod known_vectors;
mod metrics;
mod query;
mod similar;
pub mod standing;

pub use index::{catch_up, write_facts};
pub use known_vectors::KnownVectors;
pub use query::{RangeFault, Search, metric, metrics, particular, particulars, pattern};
pub use similar::nearest;
pub use sistership_store::{FactRange, FoundShip, MAX_RANGES, Page, ShipSearch};

use sistership_store::{List, ShipKey};

use crate::archive::Archive;
use crate::error::DeriveError;

/// Returns the ships that match a search. With `similar_to` their `value` is the correlation of the
/// vectors.
///
/// # Errors
/// Returns an error if the ship of `similar_to` does not exist, or if the store does not answer.
pub async fn ships(
    archive: &Archive,
    known: &KnownVectors,
    search: &Search,
    page: &Page<ShipKey>,
) -> Result<List<FoundShip, ShipKey>, DeriveError> {
    match &search.similar_to {
        None => Ok(archive.store.ships().search(&search.ships, page).await?),
        Some(ship) => similar::ships(archive, known, search, ship, page).await,
    }
}
