//! Copy of the embedded zoo into the database.

use sistership_model::{FileError, Vessel, Zoo};
use sistership_store::{NewShip, Store, StoreError};

use crate::archive::parse_vessel;
use crate::catalogue::ZooCache;
use crate::error::DeriveError;
use crate::library;
use crate::publish::publish_models;

/// Error of the copy.
#[derive(Debug, thiserror::Error)]
pub enum SeedError {
    /// The database or the object store cannot be used.
    #[error("cannot open the store: {0}")]
    Store(#[from] StoreError),
    /// The embedded zoo cannot be parsed.
    #[error("the zoo is damaged: {0}")]
    Zoo(#[from] FileError),
}

/// Stores the missing ships and laws of the embedded zoo; several processes may do so at once, and
/// an interrupted copy is continued. Without space on the disk it is left to the next start.
pub async fn seed_zoo(store: &Store, catalogue: &ZooCache) -> Result<(), SeedError> {
    match copy_zoo(store, catalogue).await {
        Err(SeedError::Store(error)) if error.is_out_of_space() => {
            tracing::error!(%error, "there is no free space for new models of the program's zoo; \
                                     they are added at the next start");
            Ok(())
        }
        other => other,
    }
}

async fn copy_zoo(store: &Store, catalogue: &ZooCache) -> Result<(), SeedError> {
    let embedded = tokio::task::spawn_blocking(Zoo::load_embedded)
        .await
        .map_err(|error| zoo_error(&error))??;
    library::store_library(store).await?;
    // Laws before ships, ships before versions: each row refers to the ones before.
    insert_laws(store, &embedded).await?;
    insert_ships(store, &embedded).await?;
    let zoo = catalogue.zoo_of_laws(store).await?;
    for name in embedded.vessels().map(|vessel| vessel.name()) {
        publish_ship(store, &zoo, name).await?;
    }
    Ok(())
}

/// Creates the versions of a ship of the embedded zoo, unless the ship was deleted.
/// [`crate::search`] does so for other ships.
async fn publish_ship(store: &Store, zoo: &Zoo, name: &str) -> Result<(), SeedError> {
    let ship = match store.ships().get(name).await {
        Err(StoreError::NotFound { .. }) => return Ok(()),
        other => other?,
    };
    match parse_vessel(name, &ship.document) {
        Ok(vessel) => publish_models(store, zoo, &vessel, &ship.document)
            .await
            .map_err(|error| publish_error(name, error)),
        Err(error) => {
            tracing::error!(ship = name, %error, "a ship of the database cannot be parsed");
            Ok(())
        }
    }
}

async fn insert_laws(store: &Store, embedded: &Zoo) -> Result<(), SeedError> {
    for law in embedded.laws() {
        let text = embedded.law_text(&law.name).unwrap_or_default();
        match store.laws().insert(&law.name, text).await {
            Err(StoreError::Conflict { .. }) => {
                tracing::warn!(law = %law.name, "the database keeps its older version of this law")
            }
            other => drop(other?),
        }
    }
    Ok(())
}

async fn insert_ships(store: &Store, embedded: &Zoo) -> Result<(), SeedError> {
    for vessel in embedded.vessels() {
        // Created, never updated: a user may have changed a ship of the zoo.
        let ship = new_ship(vessel).map_err(|error| zoo_error(&error))?;
        match store.ships().create(&ship).await {
            // It exists, was changed or was deleted: a decision of a user in each case.
            Err(StoreError::Conflict { .. }) => {}
            other => drop(other?),
        }
    }
    Ok(())
}

/// Returns a ship as a row of the store.
pub fn new_ship(vessel: &Vessel) -> Result<NewShip, serde_json::Error> {
    Ok(NewShip {
        name: vessel.name().to_owned(),
        title: vessel.file.title.clone(),
        category: vessel.file.category.clone(),
        document: serde_json::to_string(&vessel.file)?,
    })
}

fn zoo_error(error: &dyn std::fmt::Display) -> SeedError {
    damaged_file("zoo", error.to_string())
}

fn publish_error(ship: &str, error: DeriveError) -> SeedError {
    match error {
        DeriveError::Store(full) if full.is_out_of_space() => SeedError::Store(full),
        other => damaged_file(ship, other.to_string()),
    }
}

fn damaged_file(file: &str, message: String) -> SeedError {
    SeedError::Zoo(FileError {
        file: file.to_owned(),
        line: None,
        field: String::new(),
        message,
        further: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::archive::version_document;
    use sistership_store::SystemClock;
    use std::sync::Arc;

    #[tokio::test]
    async fn seeding_twice_changes_nothing_and_documents_read_back() {
        let store = Store::connect("sqlite::memory:", Arc::new(SystemClock)).await.unwrap();
        seed_zoo(&store, &ZooCache::default()).await.unwrap();
        seed_zoo(&store, &ZooCache::default()).await.unwrap();
        let embedded = Zoo::load_embedded().unwrap();
        for known in embedded.vessels() {
            let ship = store.ships().get(known.name()).await.unwrap();
            let read = parse_vessel(known.name(), &ship.document).unwrap();
            assert_eq!(new_ship(&read).unwrap().document, ship.document);
            let versions = store
                .versions()
                .list(known.name(), &sistership_store::PageRequest::first_page(10))
                .await
                .unwrap()
                .items;
            assert_eq!(versions.len(), known.file.models.len(), "{}", known.name());
            if let Ok(model) = embedded.published_model(known, None) {
                let champion = store.aliases().get(known.name(), "champion").await.unwrap();
                let version =
                    store.versions().get(known.name(), champion.version_number).await.unwrap();
                let read = version_document(&version).unwrap();
                assert_eq!((champion.version_number, &read.model), (1, &model));
                assert_eq!(read.to_canonical_json().unwrap(), version.document);
            }
        }
    }
}
