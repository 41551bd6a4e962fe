//! The zoo that the program carries, put into the database where it is not there yet.

use sistership_model::{FileError, Vessel, Zoo};
use sistership_store::{NewShip, Store, StoreError};

use crate::archive::vessel;
use crate::catalogue::Catalogue;
use crate::error::DeriveError;
use crate::library;
use crate::publish::publish;

/// Why the zoo cannot be put in.
#[derive(Debug, thiserror::Error)]
pub enum SeedError {
    /// The database or the object store cannot be used.
    #[error("cannot open the store: {0}")]
    Store(#[from] StoreError),
    /// The zoo that the program carries does not read.
    #[error("the zoo is damaged: {0}")]
    Zoo(#[from] FileError),
}

/// Puts in what is missing; several processes may do so at once, and one that was killed half-way
/// is continued. Where there is no room for it, the next start puts it in.
pub async fn seed(store: &Store, catalogue: &Catalogue) -> Result<(), SeedError> {
    match put_in(store, catalogue).await {
        Err(SeedError::Store(error)) if error.is_out_of_space() => {
            tracing::error!(%error, "there is no room for what is new in the program's own zoo; \
                the next start puts it in");
            Ok(())
        }
        other => other,
    }
}

async fn put_in(store: &Store, catalogue: &Catalogue) -> Result<(), SeedError> {
    let embedded =
        tokio::task::spawn_blocking(Zoo::embedded).await.map_err(|error| broken(&error))??;
    library::keep(store).await?;
    laws(store, &embedded).await?;
    ships(store, &embedded).await?;
    let zoo = catalogue.laws(store).await?;
    for name in embedded.vessels().map(|vessel| vessel.name()) {
        publish_one(store, &zoo, name).await?;
    }
    Ok(())
}

/// Makes the versions of a ship of the program's own, unless it was deleted. Those of other ships
/// are looked after by [`crate::search`].
async fn publish_one(store: &Store, zoo: &Zoo, name: &str) -> Result<(), SeedError> {
    let ship = match store.ships().get(name).await {
        Err(StoreError::NotFound { .. }) => return Ok(()),
        other => other?,
    };
    match vessel(name, &ship.document) {
        Ok(vessel) => publish(store, zoo, &vessel, &ship.document)
            .await
            .map_err(|error| publishing(name, error)),
        Err(error) => {
            tracing::error!(ship = name, %error, "a ship of the database does not read");
            Ok(())
        }
    }
}

async fn laws(store: &Store, embedded: &Zoo) -> Result<(), SeedError> {
    for law in embedded.laws() {
        let text = embedded.law_text(&law.name).unwrap_or_default();
        match store.laws().insert(&law.name, text).await {
            Err(StoreError::Conflict { .. }) => {
                tracing::warn!(law = %law.name, "the database keeps its older text of this law")
            }
            other => drop(other?),
        }
    }
    Ok(())
}

async fn ships(store: &Store, embedded: &Zoo) -> Result<(), SeedError> {
    for vessel in embedded.vessels() {
        let ship = new_ship(vessel).map_err(|error| broken(&error))?;
        match store.ships().create(&ship).await {
            // It is there, changed, or was deleted: in each case somebody's decision.
            Err(StoreError::Conflict { .. }) => {}
            other => drop(other?),
        }
    }
    Ok(())
}

/// A ship as the store keeps it.
pub fn new_ship(vessel: &Vessel) -> Result<NewShip, serde_json::Error> {
    Ok(NewShip {
        name: vessel.name().to_owned(),
        title: vessel.file.title.clone(),
        category: vessel.file.category.clone(),
        document: serde_json::to_string(&vessel.file)?,
    })
}

fn broken(error: &dyn std::fmt::Display) -> SeedError {
    damaged("zoo", error.to_string())
}

fn publishing(ship: &str, error: DeriveError) -> SeedError {
    match error {
        DeriveError::Store(full) if full.is_out_of_space() => SeedError::Store(full),
        other => damaged(ship, other.to_string()),
    }
}

fn damaged(file: &str, message: String) -> SeedError {
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
    use crate::archive::document;
    use sistership_store::SystemClock;
    use std::sync::Arc;

    #[tokio::test]
    async fn seeding_twice_changes_nothing_and_documents_read_back() {
        let store = Store::connect("sqlite::memory:", Arc::new(SystemClock)).await.unwrap();
        seed(&store, &Catalogue::default()).await.unwrap();
        seed(&store, &Catalogue::default()).await.unwrap();
        let embedded = Zoo::embedded().unwrap();
        for known in embedded.vessels() {
            let ship = store.ships().get(known.name()).await.unwrap();
            let read = vessel(known.name(), &ship.document).unwrap();
            assert_eq!(new_ship(&read).unwrap().document, ship.document);
            let versions = store
                .versions()
                .list(known.name(), &sistership_store::Page::first(10))
                .await
                .unwrap()
                .items;
            assert_eq!(versions.len(), known.file.models.len(), "{}", known.name());
            if let Ok(model) = embedded.published(known, None) {
                let champion = store.aliases().get(known.name(), "champion").await.unwrap();
                let version =
                    store.versions().get(known.name(), champion.version_number).await.unwrap();
                let read = document(&version).unwrap();
                assert_eq!((champion.version_number, &read.model), (1, &model));
                assert_eq!(read.canonical().unwrap(), version.document);
            }
        }
    }
}
