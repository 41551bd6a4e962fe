//! Cache of characteristic vectors: thousands of ships are compared, and reading their rows would
//! take most of the time of a request.

use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

use sistership_priors::similarity::{CharacteristicVector, Definition, NormalisedComponents};
use sistership_store::{ObjectsError, ShipSearch, ShipVectors, Store, StoreError, VectorsState};

use super::facts;

/// Ships of a category by name, with their normalised components.
pub(super) type Vectors = Arc<Vec<(String, NormalisedComponents)>>;
/// Category and name of a definition.
type Key = (String, &'static str);

/// Cached vectors, each valid as long as no vector of its category changes.
#[derive(Debug, Default)]
pub struct KnownVectors(RwLock<BTreeMap<Key, (VectorsState, Vectors)>>);

impl KnownVectors {
    /// Returns the vectors of a category; reads them only if one of them has changed.
    pub(super) async fn of(
        &self,
        store: &Store,
        category: &str,
        definition: Definition,
    ) -> Result<Vectors, StoreError> {
        // The state is read before the vectors: a change in between is noticed the next time.
        let state = store.ships().vectors_state(category).await?;
        let key = (category.to_owned(), definition.name());
        if let Some(known) = self.known(&key, &state) {
            return Ok(known);
        }
        let search = ShipSearch { category: Some(category.to_owned()), ..ShipSearch::default() };
        let rows = store.ships().vectors(&search).await?;
        // Parsing thousands of rows would block the threads that serve.
        let read = tokio::task::spawn_blocking(move || read(&rows, definition));
        let vectors = Arc::new(read.await.map_err(ObjectsError::from)?);
        let mut all = self.0.write().unwrap_or_else(PoisonError::into_inner);
        all.insert(key, (state, Arc::clone(&vectors)));
        Ok(vectors)
    }

    /// Reads the vectors of every category that has changed, so that no search has to wait for it.
    ///
    /// # Errors
    /// Returns an error if the database does not answer.
    pub async fn catch_up(&self, store: &Store) -> Result<(), StoreError> {
        for category in store.ships().vector_categories().await? {
            for definition in Definition::ALL {
                self.of(store, &category, definition).await?;
            }
        }
        Ok(())
    }

    fn known(&self, key: &Key, state: &VectorsState) -> Option<Vectors> {
        let all = self.0.read().unwrap_or_else(PoisonError::into_inner);
        let (then, vectors) = all.get(key)?;
        (then == state).then(|| Arc::clone(vectors))
    }
}

fn read(rows: &[ShipVectors], definition: Definition) -> Vec<(String, NormalisedComponents)> {
    let one = |row: &ShipVectors| {
        let values = facts::vector(&row.vectors, definition.name())?;
        let vector = CharacteristicVector { definition, values };
        Some((row.head.name.clone(), vector.components()))
    };
    rows.iter().filter_map(one).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_store::{NewShip, ShipFacts, SystemClock};

    /// What the search index knows of a ship.
    async fn put(store: &Store, vectors: &str) {
        for waiting in store.search_index().waiting("", 10).await.unwrap() {
            let category = "tanker".to_owned();
            let vectors = vectors.to_owned();
            let facts = ShipFacts { waiting, category, facts: Vec::new(), vectors };
            store.search_index().write(&[facts]).await.unwrap();
        }
    }

    async fn store_of(ship: &NewShip) -> Store {
        let store = Store::connect("sqlite::memory:", Arc::new(SystemClock)).await.unwrap();
        store.ships().create(ship).await.unwrap();
        store
    }

    fn kvlcc2() -> NewShip {
        let zoo = sistership_model::Zoo::embedded().unwrap();
        crate::seed::new_ship(zoo.vessel("kvlcc2").unwrap()).unwrap()
    }

    #[tokio::test]
    async fn vectors_of_every_category_are_read_before_anybody_asks() {
        let store = store_of(&kvlcc2()).await;
        put(&store, r#"{"mei-2019":{"C_b":0.8}}"#).await;
        let known = KnownVectors::default();
        known.catch_up(&store).await.unwrap();
        let state = store.ships().vectors_state("tanker").await.unwrap();
        let read = known.known(&("tanker".to_owned(), Definition::Mei2019.name()), &state).unwrap();
        assert_eq!(read.len(), 1);
        let asked = known.of(&store, "tanker", Definition::Mei2019).await.unwrap();
        assert!(Arc::ptr_eq(&read, &asked));
    }

    #[tokio::test]
    async fn vectors_are_read_again_where_one_has_changed() {
        let kvlcc2 = kvlcc2();
        let store = store_of(&kvlcc2).await;
        let known = KnownVectors::default();
        let of = async || known.of(&store, "tanker", Definition::Mei2019).await.unwrap();
        assert!(of().await.is_empty());
        put(&store, r#"{"mei-2019":{"C_b":0.8}}"#).await;
        let first = of().await;
        assert_eq!(first.len(), 1);
        assert!(Arc::ptr_eq(&first, &of().await), "nothing has changed");
        store.ships().update(&kvlcc2, 1).await.unwrap();
        put(&store, r#"{"mei-2019":{"C_b":0.7}}"#).await;
        let second = of().await;
        assert_ne!(first, second);
        store.ships().delete("kvlcc2", None).await.unwrap();
        put(&store, "{}").await;
        assert!(of().await.is_empty());
    }
}
