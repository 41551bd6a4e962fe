//! Search for ships: by category, tag, particulars, metrics of the champion, and similarity to a
//! ship.

mod facts;
mod index;
mod known_vectors;
mod metrics;
pub mod position;
mod query;
mod similar;
pub mod urgency;

pub use index::{update_index, write_facts};
pub use known_vectors::VectorCache;
pub use query::{
    RangeFault, SearchCriteria, metric, particular, particular_names, range_pattern,
    searchable_metrics,
};
pub use similar::nearest_ships;
pub use sistership_store::{FactRange, FoundShip, MAX_RANGES, PageRequest, ShipSearch};

use sistership_store::{ListPage, ShipKey};

use crate::archive::Archive;
use crate::error::DeriveError;

/// Returns the ships that match a search. With `similar_to` their `value` is the correlation of the
/// vectors.
///
/// # Errors
/// Returns an error if the ship of `similar_to` does not exist, or if the store does not answer.
pub async fn search_ships(
    archive: &Archive,
    known: &VectorCache,
    search: &SearchCriteria,
    page: &PageRequest<ShipKey>,
) -> Result<ListPage<FoundShip, ShipKey>, DeriveError> {
    match &search.similar_to {
        None => Ok(archive.store.ships().search_ships(&search.ships, page).await?),
        Some(ship) => similar::search_similar(archive, known, search, ship, page).await,
    }
}
