//! Cache of characteristic vectors: thousands of ships are compared, and reading their rows would
//! take most of the time of a request.

use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

use sistership_priors::similarity::{CharacteristicVector, NormalisedComponents, VectorDefinition};
use sistership_store::{ObjectsError, ShipSearch, ShipVectors, Store, StoreError, VectorsState};

use super::facts;

/// Ships of a category by name, with their normalised components.
pub(super) type CategoryVectors = Arc<Vec<(String, NormalisedComponents)>>;
/// Category and name of a definition.
type VectorKey = (String, &'static str);

/// Cached vectors, each valid as long as no vector of its category changes.
#[derive(Debug, Default)]
pub struct VectorCache(RwLock<BTreeMap<VectorKey, (VectorsState, CategoryVectors)>>);

impl VectorCache {
    /// Returns the vectors of a category; reads them only if one of them has changed.
    pub(super) async fn category_vectors(
        &self,
        store: &Store,
        category: &str,
        definition: VectorDefinition,
    ) -> Result<CategoryVectors, StoreError> {
        // The state is read before the vectors: a change in between is noticed the next time.
        let state = store.ships().vectors_state(category).await?;
        let key = (category.to_owned(), definition.name());
        if let Some(known) = self.cached_vectors(&key, &state) {
            return Ok(known);
        }
        let search = ShipSearch { category: Some(category.to_owned()), ..ShipSearch::default() };
        let rows = store.ships().similarity_vectors(&search).await?;
        // Parsing thousands of rows would block the threads that serve.
        let read = tokio::task::spawn_blocking(move || normalise_rows(&rows, definition));
        let vectors = Arc::new(read.await.map_err(ObjectsError::from)?);
        let mut all = self.0.write().unwrap_or_else(PoisonError::into_inner);
        all.insert(key, (state, Arc::clone(&vectors)));
        Ok(vectors)
    }

    /// Reads the vectors of every category that has changed, so that no search has to wait for it.
    ///
    /// # Errors
    /// Returns an error if the database does not answer.
    pub async fn refresh_all(&self, store: &Store) -> Result<(), StoreError> {
        for category in store.ships().vector_categories().await? {
            for definition in VectorDefinition::ALL {
                self.category_vectors(store, &category, definition).await?;
            }
        }
        Ok(())
    }

    fn cached_vectors(&self, key: &VectorKey, state: &VectorsState) -> Option<CategoryVectors> {
        let all = self.0.read().unwrap_or_else(PoisonError::into_inner);
        let (then, vectors) = all.get(key)?;
        (then == state).then(|| Arc::clone(vectors))
    }
}

fn normalise_rows(
    rows: &[ShipVectors],
    definition: VectorDefinition,
) -> Vec<(String, NormalisedComponents)> {
    let one = |row: &ShipVectors| {
        let values = facts::parse_vector(&row.vectors, definition.name())?;
        let vector = CharacteristicVector { definition, values };
        Some((row.head.name.clone(), vector.normalised_components()))
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
        for waiting in store.search_index().list_stale("", 10).await.unwrap() {
            let category = "tanker".to_owned();
            let vectors = vectors.to_owned();
            let facts = ShipFacts { waiting, category, facts: Vec::new(), vectors };
            store.search_index().write_facts(&[facts]).await.unwrap();
        }
    }

    async fn store_of(ship: &NewShip) -> Store {
        let store = Store::connect("sqlite::memory:", Arc::new(SystemClock)).await.unwrap();
        store.ships().create(ship).await.unwrap();
        store
    }

    fn kvlcc2() -> NewShip {
        let zoo = sistership_model::Zoo::load_embedded().unwrap();
        crate::seed::new_ship(zoo.vessel("kvlcc2").unwrap()).unwrap()
    }

    #[tokio::test]
    async fn vectors_of_every_category_are_read_before_anybody_asks() {
        let store = store_of(&kvlcc2()).await;
        put(&store, r#"{"mei-2019":{"C_b":0.8}}"#).await;
        let known = VectorCache::default();
        known.refresh_all(&store).await.unwrap();
        let state = store.ships().vectors_state("tanker").await.unwrap();
        let read = known
            .cached_vectors(&("tanker".to_owned(), VectorDefinition::Mei2019.name()), &state)
            .unwrap();
        assert_eq!(read.len(), 1);
        let asked =
            known.category_vectors(&store, "tanker", VectorDefinition::Mei2019).await.unwrap();
        assert!(Arc::ptr_eq(&read, &asked));
    }

    #[tokio::test]
    async fn vectors_are_read_again_where_one_has_changed() {
        let kvlcc2 = kvlcc2();
        let store = store_of(&kvlcc2).await;
        let known = VectorCache::default();
        let of = async || {
            known.category_vectors(&store, "tanker", VectorDefinition::Mei2019).await.unwrap()
        };
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
