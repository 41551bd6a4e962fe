//! The laws and ships of the database in memory, read and checked once.
//!
//! Other processes may change the database, so that whoever needs the zoo asks for it anew; only what has changed is
//! read again.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, PoisonError, RwLock};

use sistership_model::Zoo;
use sistership_store::{Law, MAX_LIMIT, Page, Result, Ship, Store};

/// The zoo as it was last seen.
#[derive(Debug, Default)]
pub(crate) struct Catalogue(RwLock<Snapshot>);

#[derive(Debug, Clone, Default)]
struct Snapshot {
    laws: BTreeSet<String>,
    ships: BTreeMap<String, i64>,
    zoo: Arc<Zoo>,
}

impl Catalogue {
    /// The zoo as the database has it now.
    pub(crate) async fn refresh(&self, store: &Store) -> Result<Arc<Zoo>> {
        let (laws, ships) = (all_laws(store).await?, all_ships(store).await?);
        let seen = self.0.read().unwrap_or_else(PoisonError::into_inner).clone();
        if seen.is(&laws, &ships) {
            return Ok(seen.zoo);
        }
        let old = Arc::clone(&seen.zoo);
        let fresh = match tokio::task::spawn_blocking(move || seen.grown(&laws, &ships)).await {
            Ok(fresh) => fresh,
            Err(error) => {
                tracing::error!(%error, "the zoo could not be read anew");
                return Ok(old);
            }
        };
        let zoo = Arc::clone(&fresh.zoo);
        *self.0.write().unwrap_or_else(PoisonError::into_inner) = fresh;
        Ok(zoo)
    }
}

impl Catalogue {
    /// A law. It never changes, so that the one in memory is the right one.
    pub(crate) async fn law(&self, store: &Store, name: &str) -> Result<Option<Arc<sistership_model::Law>>> {
        let known = self.0.read().unwrap_or_else(PoisonError::into_inner).zoo.law(name).cloned();
        match known {
            Some(law) => Ok(Some(law)),
            None => Ok(self.refresh(store).await?.law(name).cloned()),
        }
    }
}

impl Snapshot {
    fn is(&self, laws: &[Law], ships: &[Ship]) -> bool {
        self.laws.len() == laws.len() && self.ships.len() == ships.len() && ships.iter().all(|ship| self.has(ship))
    }

    fn has(&self, ship: &Ship) -> bool {
        self.ships.get(&ship.name) == Some(&ship.revision)
    }

    /// This snapshot with what is new; from nothing where a ship has gone.
    fn grown(&self, laws: &[Law], ships: &[Ship]) -> Self {
        let names: BTreeSet<&str> = ships.iter().map(|ship| ship.name.as_str()).collect();
        let gone = self.ships.keys().any(|name| !names.contains(name.as_str()));
        let mut grown = if gone { Self::default() } else { self.clone() };
        let mut zoo = Zoo::clone(&grown.zoo);
        for law in laws.iter().filter(|law| !self.laws.contains(&law.name) || gone) {
            report("law", &law.name, zoo.add_law(&law.name, &law.document).err());
        }
        for ship in ships.iter().filter(|ship| gone || !self.has(ship)) {
            report("ship", &ship.name, zoo.add_vessel(&ship.name, &ship.document).err());
        }
        grown.laws = laws.iter().map(|law| law.name.clone()).collect();
        grown.ships = ships.iter().map(|ship| (ship.name.clone(), ship.revision)).collect();
        grown.zoo = Arc::new(zoo);
        grown
    }
}

/// One row that does not read must not keep the others from being served.
fn report(kind: &str, name: &str, error: Option<sistership_model::FileError>) {
    if let Some(error) = error {
        tracing::error!(%error, "the {kind} `{name}` of the database does not read and is left out");
    }
}

/// Every law of the database.
pub(crate) async fn all_laws(store: &Store) -> Result<Vec<Law>> {
    let (mut all, mut page) = (Vec::new(), Page::first(MAX_LIMIT));
    loop {
        let list = store.laws().list(&page).await?;
        all.extend(list.items);
        let Some(next) = list.next else { return Ok(all) };
        page = Page::after(next, MAX_LIMIT);
    }
}

/// Every ship of the database that is not deleted.
pub(crate) async fn all_ships(store: &Store) -> Result<Vec<Ship>> {
    let (mut all, mut page) = (Vec::new(), Page::first(MAX_LIMIT));
    loop {
        let list = store.ships().list(None, &page).await?;
        all.extend(list.items);
        let Some(next) = list.next else { return Ok(all) };
        page = Page::after(next, MAX_LIMIT);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_store::NewShip;
    use std::sync::Arc;

    #[tokio::test]
    async fn the_zoo_follows_the_database() {
        let store = Store::connect("sqlite::memory:", Arc::new(sistership_store::SystemClock)).await.unwrap();
        let catalogue = Catalogue::default();
        assert_eq!(catalogue.refresh(&store).await.unwrap().vessels().count(), 0);
        let embedded = Zoo::embedded().unwrap();
        let mariner = crate::seed::new_ship(embedded.vessel("mariner").unwrap()).unwrap();
        for law in embedded.laws() {
            store.laws().insert(&law.name, embedded.law_text(&law.name).unwrap()).await.unwrap();
        }
        store.ships().create(&mariner).await.unwrap();
        let zoo = catalogue.refresh(&store).await.unwrap();
        assert_eq!(zoo.model("mariner").unwrap(), embedded.model("mariner").unwrap());
        assert!(Arc::ptr_eq(&zoo, &catalogue.refresh(&store).await.unwrap()));
        store.ships().update(&NewShip { document: mariner.document.replace("Mariner", "Marinara"), ..mariner }, 1).await.unwrap();
        assert!(catalogue.refresh(&store).await.unwrap().vessel("mariner").unwrap().file.title.contains("Marinara"));
        store.ships().delete("mariner", None).await.unwrap();
        assert!(catalogue.refresh(&store).await.unwrap().vessel("mariner").is_none());
    }
}
