//! Laws and ships of the database in memory, read and checked once.
//!
//! Other processes may change the database, so the zoo is requested for each use; only rows that
//! have changed are read again. A zoo holds a limited number of ships, regardless of the size of
//! the database.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, PoisonError, RwLock};

use sistership_model::{Vessel, Zoo};
use sistership_store::{
    FoundShip, Law, PageRequest, Result, Ship, ShipSearch, Store, StoreError, read_all_pages,
};

use crate::archive::Archive;
use crate::search::{VectorCache, nearest_ships};

/// Largest number of ships that a ship is compared with.
pub const MAX_COMPARED_SHIPS: usize = 250;
/// The same number as the limit of a page.
const PAGE: i64 = MAX_COMPARED_SHIPS as i64;

/// Cache of the zoo as it was last read.
#[derive(Debug, Default)]
pub struct ZooCache {
    laws: RwLock<CachedLaws>,
    ships: RwLock<CachedShips>,
    vectors: VectorCache,
}

/// Laws without ships, with the hashes of their texts.
#[derive(Debug, Clone, Default)]
struct CachedLaws {
    hashes: Arc<BTreeMap<String, String>>,
    zoo: Arc<Zoo>,
}

/// Law with the hash of its text.
#[derive(Debug, Clone)]
pub struct KnownLaw {
    /// The law.
    pub law: Arc<sistership_model::Law>,
    /// The hash of its text.
    pub sha256: String,
}

/// Ships with their revisions, and the laws that they were read with.
#[derive(Debug, Clone, Default)]
struct CachedShips {
    revisions: BTreeMap<String, i64>,
    laws: Arc<Zoo>,
    zoo: Arc<Zoo>,
}

impl ZooCache {
    /// Returns the laws of the database, without ships.
    pub async fn zoo_of_laws(&self, store: &Store) -> Result<Arc<Zoo>> {
        let (laws, seen) = (read_laws(store).await?, read_cache(&self.laws));
        // Laws are insert-only, so names are enough to see whether the cache is current.
        if laws.iter().all(|law| seen.hashes.contains_key(&law.name)) {
            return Ok(seen.zoo);
        }
        let fresh = parse_blocking(move || seen.with_laws(&laws)).await?;
        Ok(update_cache(&self.laws, fresh).zoo)
    }

    /// Returns the laws of the database with the ships that a target is compared with: all of them
    /// if a page holds them, else the `count` most similar ones of its category.
    pub async fn zoo_for_target(
        &self,
        archive: &Archive,
        target: &Vessel,
        count: usize,
    ) -> Result<Arc<Zoo>> {
        let laws = self.zoo_of_laws(&archive.store).await?;
        let heads = self.ships_to_compare(archive, target, count).await?;
        let seen = read_cache(&self.ships);
        if seen.is_current(&laws, &heads) {
            return Ok(seen.zoo);
        }
        let kept = seen.retain_valid(laws, &heads);
        // Concurrent calls may both read and store a zoo; each result is complete, the last one
        // stays.
        let ships =
            read_ships(&archive.store, heads.iter().filter(|head| !kept.has_revision(head)))
                .await?;
        let fresh = parse_blocking(move || kept.with_ships(&ships)).await?;
        Ok(update_cache(&self.ships, fresh).zoo)
    }

    /// Cache of the feature vectors of ships.
    pub fn known_vectors(&self) -> &VectorCache {
        &self.vectors
    }

    /// Returns the ships that a target is compared with, without their documents.
    async fn ships_to_compare(
        &self,
        archive: &Archive,
        target: &Vessel,
        count: usize,
    ) -> Result<Vec<FoundShip>> {
        let few = archive
            .store
            .ships()
            .search_ships(&ShipSearch::default(), &PageRequest::first_page(PAGE))
            .await?;
        match few.next {
            None => Ok(few.items),
            Some(_) => nearest_ships(archive, &self.vectors, target, count).await,
        }
    }

    /// Returns a law by name. A law never changes, so a cached one is valid.
    pub async fn find_law(&self, store: &Store, name: &str) -> Result<Option<KnownLaw>> {
        if let Some(known) = read_cache(&self.laws).cached_law(name) {
            return Ok(Some(known));
        }
        self.zoo_of_laws(store).await?;
        Ok(read_cache(&self.laws).cached_law(name))
    }
}

fn read_cache<T: Clone>(kept: &RwLock<T>) -> T {
    // Values are replaced as a whole, so a poisoned lock still holds a valid one.
    kept.read().unwrap_or_else(PoisonError::into_inner).clone()
}

fn update_cache<T: Clone>(kept: &RwLock<T>, fresh: T) -> T {
    kept.write().unwrap_or_else(PoisonError::into_inner).clone_from(&fresh);
    fresh
}

/// Parses documents on a blocking thread.
async fn parse_blocking<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Result<T> {
    Ok(tokio::task::spawn_blocking(work).await.map_err(sistership_store::ObjectsError::from)?)
}

impl CachedLaws {
    fn cached_law(&self, name: &str) -> Option<KnownLaw> {
        Some(KnownLaw {
            law: Arc::clone(self.zoo.law(name)?),
            sha256: self.hashes.get(name)?.clone(),
        })
    }

    /// Returns the cache with the new laws added.
    fn with_laws(self, laws: &[Law]) -> Self {
        let mut zoo = Zoo::clone(&self.zoo);
        for law in laws.iter().filter(|law| !self.hashes.contains_key(&law.name)) {
            log_failure("law", &law.name, zoo.add_law(&law.name, &law.document).err());
        }
        let hashes = laws.iter().map(|law| (law.name.clone(), law.sha256.clone())).collect();
        Self { hashes: Arc::new(hashes), zoo: Arc::new(zoo) }
    }
}

impl CachedShips {
    fn is_current(&self, laws: &Arc<Zoo>, ships: &[FoundShip]) -> bool {
        Arc::ptr_eq(&self.laws, laws)
            && self.revisions.len() == ships.len()
            && ships.iter().all(|ship| self.has_revision(ship))
    }

    fn has_revision(&self, ship: &FoundShip) -> bool {
        self.revisions.get(&ship.name) == Some(&ship.revision)
    }

    /// Returns the entries that are still valid; none if a ship was removed or the laws have
    /// changed.
    fn retain_valid(self, laws: Arc<Zoo>, ships: &[FoundShip]) -> Self {
        let names: BTreeSet<&str> = ships.iter().map(|ship| ship.name.as_str()).collect();
        // A removed ship or another set of laws invalidates every entry; the zoo is built anew.
        let gone = self.revisions.keys().any(|name| !names.contains(name.as_str()));
        if gone || !Arc::ptr_eq(&self.laws, &laws) || self.revisions.is_empty() {
            return Self { revisions: BTreeMap::new(), zoo: Arc::clone(&laws), laws };
        }
        self
    }

    /// Returns the cache with further ships added.
    fn with_ships(mut self, ships: &[Ship]) -> Self {
        let mut zoo = Zoo::clone(&self.zoo);
        for ship in ships {
            log_failure("ship", &ship.name, zoo.add_vessel(&ship.name, &ship.document).err());
            self.revisions.insert(ship.name.clone(), ship.revision);
        }
        Self { zoo: Arc::new(zoo), ..self }
    }
}

/// Logs a row that cannot be parsed; the others are served.
fn log_failure(kind: &str, name: &str, error: Option<sistership_model::FileError>) {
    if let Some(error) = error {
        tracing::error!(%error, "the {kind} `{name}` of the database cannot be parsed and is \
                                 ignored");
    }
}

/// Reads all laws of the database.
async fn read_laws(store: &Store) -> Result<Vec<Law>> {
    let laws = store.laws();
    read_all_pages(|page| async move { laws.list(&page).await }).await
}

async fn read_ships(store: &Store, heads: impl Iterator<Item = &FoundShip>) -> Result<Vec<Ship>> {
    let mut ships = Vec::new();
    for head in heads {
        match store.ships().get(&head.name).await {
            // Deleted after the list was read.
            Err(StoreError::NotFound { .. }) => {}
            ship => ships.push(ship?),
        }
    }
    Ok(ships)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_store::{NewShip, ObjectStorage};

    #[tokio::test]
    async fn the_zoo_follows_the_database() {
        let store = Store::connect("sqlite::memory:", Arc::new(sistership_store::SystemClock))
            .await
            .unwrap();
        let archive = Archive { store: store.clone(), objects: ObjectStorage::in_memory() };
        let catalogue = ZooCache::default();
        let embedded = Zoo::load_embedded().unwrap();
        let target = embedded.vessel("mariner").unwrap();
        assert_eq!(
            catalogue
                .zoo_for_target(&archive, target, MAX_COMPARED_SHIPS)
                .await
                .unwrap()
                .vessels()
                .count(),
            0
        );
        let mariner = crate::seed::new_ship(target).unwrap();
        for law in embedded.laws() {
            store.laws().insert(&law.name, embedded.law_text(&law.name).unwrap()).await.unwrap();
        }
        store.ships().create(&mariner).await.unwrap();
        let zoo = catalogue.zoo_for_target(&archive, target, MAX_COMPARED_SHIPS).await.unwrap();
        assert_eq!(zoo.find_model("mariner").unwrap(), embedded.find_model("mariner").unwrap());
        assert_eq!(catalogue.zoo_of_laws(&store).await.unwrap().vessels().count(), 0);
        assert!(Arc::ptr_eq(
            &zoo,
            &catalogue.zoo_for_target(&archive, target, MAX_COMPARED_SHIPS).await.unwrap()
        ));
        store
            .ships()
            .update(
                &NewShip { document: mariner.document.replace("Mariner", "Marinara"), ..mariner },
                1,
            )
            .await
            .unwrap();
        let zoo = catalogue.zoo_for_target(&archive, target, MAX_COMPARED_SHIPS).await.unwrap();
        assert!(zoo.vessel("mariner").unwrap().file.title.contains("Marinara"));
        store.ships().delete("mariner", None).await.unwrap();
        assert!(
            catalogue
                .zoo_for_target(&archive, target, MAX_COMPARED_SHIPS)
                .await
                .unwrap()
                .vessel("mariner")
                .is_none()
        );
    }

    /// Beyond [`MOST`] ships, those of the target's category that resemble it; others stay out.
    #[tokio::test]
    async fn of_many_ships_the_most_similar_are_taken() {
        let store = Store::connect("sqlite::memory:", Arc::new(sistership_store::SystemClock))
            .await
            .unwrap();
        let archive = Archive { store: store.clone(), objects: ObjectStorage::in_memory() };
        let embedded = Zoo::load_embedded().unwrap();
        let target = embedded.vessel("kvlcc2").unwrap();
        let kvlcc2 = crate::seed::new_ship(target).unwrap();
        for number in 0..=MAX_COMPARED_SHIPS {
            let other = NewShip {
                name: format!("other-{number:03}"),
                category: "ferry".into(),
                ..kvlcc2.clone()
            };
            store.ships().create(&other).await.unwrap();
        }
        for law in embedded.laws() {
            store.laws().insert(&law.name, embedded.law_text(&law.name).unwrap()).await.unwrap();
        }
        for vessel in embedded.vessels() {
            store.ships().create(&crate::seed::new_ship(vessel).unwrap()).await.unwrap();
        }
        crate::search::update_index(&archive).await.unwrap();
        let zoo =
            ZooCache::default().zoo_for_target(&archive, target, MAX_COMPARED_SHIPS).await.unwrap();
        let taken: Vec<&str> = zoo.vessels().map(|vessel| vessel.name()).collect();
        let same = |vessel: &&Arc<Vessel>| {
            vessel.file.category == target.file.category && vessel.name() != target.name()
        };
        let expected: Vec<&str> =
            embedded.vessels().filter(same).map(|vessel| vessel.name()).collect();
        assert!(!expected.is_empty());
        assert_eq!(taken, expected);
        let one = ZooCache::default().zoo_for_target(&archive, target, 1).await.unwrap();
        let near = nearest_ships(&archive, &VectorCache::default(), target, 1).await.unwrap();
        assert_eq!(one.vessels().map(|vessel| vessel.name()).collect::<Vec<_>>(), [&near[0].name]);
    }
}
