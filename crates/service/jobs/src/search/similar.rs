//! Similarity search: the correlation of characteristic vectors, within a category.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use sistership_model::Vessel;
use sistership_priors::similarity::{CharacteristicVector, NormalisedComponents, VectorDefinition};
use sistership_priors::source::definition_for;
use sistership_store::{
    FoundShip, ListPage, PageRequest, ShipKey, ShipSearch, ShipVectors, StoreError,
};

use super::facts;
use super::known_vectors::VectorCache;
use super::query::SearchCriteria;
use crate::archive::{Archive, parse_vessel};
use crate::error::DeriveError;

/// Returns the ships that match a search, most similar first, without the ship itself.
pub(super) async fn search_similar(
    archive: &Archive,
    known: &VectorCache,
    search: &SearchCriteria,
    ship: &str,
    page: &PageRequest<ShipKey>,
) -> Result<ListPage<FoundShip, ShipKey>, DeriveError> {
    page.check_limit()?;
    let ship = archive.store.ships().get(ship).await?;
    let target = parse_vessel(&ship.name, &ship.document)?;
    let definition = search.vector.unwrap_or_else(|| definition_for(&target));
    // Fast path: without further criteria the cached vectors of the category are enough.
    if search.ships.tag.is_none() && search.ships.ranges.is_empty() {
        let category = search.ships.category.as_ref().unwrap_or(&target.file.category);
        let vectors = known.category_vectors(&archive.store, category, definition).await?;
        return Ok(page_of_category(archive, &vectors, &target, definition, page).await?);
    }
    // With tag or ranges the database selects, and the rows bring their vectors.
    let mut found = rank_filtered(archive, &search.ships, &target, definition).await?;
    if let Some(after) = &page.after {
        let after = (after.0, after.1.as_str());
        found.retain(|ship| compare_keys(sort_key(ship), after) == Ordering::Greater);
    }
    Ok(page.build_page(found, page_key))
}

/// Returns a page of all ships of a category, most similar first.
async fn page_of_category(
    archive: &Archive,
    vectors: &[(String, NormalisedComponents)],
    target: &Vessel,
    definition: VectorDefinition,
    page: &PageRequest<ShipKey>,
) -> Result<ListPage<FoundShip, ShipKey>, StoreError> {
    let components = CharacteristicVector::from_vessel(target, definition).normalised_components();
    let mut keys = rank_names(vectors, target.name(), &components);
    if let Some(after) = &page.after {
        let after = (after.0, after.1.as_str());
        keys.retain(|key| compare_keys(*key, after) == Ordering::Greater);
    }
    let wanted = usize::try_from(page.limit).unwrap_or(0);
    let ListPage { items, next } = page.build_page(keys, |key| (key.0, key.1.to_owned()));
    // Only the rows of this page are read; the ranking itself needs names and vectors.
    let names: Vec<String> = items.iter().take(wanted).map(|key| key.1.to_owned()).collect();
    let mut heads: BTreeMap<String, FoundShip> = BTreeMap::new();
    for head in archive.store.ships().find_by_names(&names).await? {
        heads.insert(head.name.clone(), head);
    }
    let found = |(value, name): (Option<f64>, &str)| {
        heads.remove(name).map(|head| FoundShip { value, ..head })
    };
    Ok(ListPage { items: items.into_iter().filter_map(found).collect(), next })
}

/// Returns correlation and name of each ship, most similar first, without the ship itself.
fn rank_names<'a>(
    all: &'a [(String, NormalisedComponents)],
    name: &str,
    target: &NormalisedComponents,
) -> Vec<(Option<f64>, &'a str)> {
    let others = all.iter().filter(|(other, _)| other != name);
    let mut found: Vec<_> = others
        .filter_map(|(other, of)| Some((Some(target.correlation(of)?), other.as_str())))
        .collect();
    found.sort_unstable_by(|a, b| compare_keys(*a, *b));
    found
}

/// Returns the ships of a category that are most similar to a target, at most `count`, in no order.
pub async fn nearest_ships(
    archive: &Archive,
    known: &VectorCache,
    target: &Vessel,
    count: usize,
) -> Result<Vec<FoundShip>, StoreError> {
    let definition = definition_for(target);
    let vectors = known.category_vectors(&archive.store, &target.file.category, definition).await?;
    let components = CharacteristicVector::from_vessel(target, definition).normalised_components();
    archive
        .store
        .ships()
        .find_by_names(&nearest_names(&vectors, target.name(), &components, count))
        .await
}

/// Returns the names of the most similar ships, without the ship itself.
fn nearest_names(
    all: &[(String, NormalisedComponents)],
    name: &str,
    target: &NormalisedComponents,
    count: usize,
) -> Vec<String> {
    let found = rank_names(all, name, target).into_iter().take(count);
    found.map(|(_, other)| other.to_owned()).collect()
}

async fn rank_filtered(
    archive: &Archive,
    search: &ShipSearch,
    target: &Vessel,
    definition: VectorDefinition,
) -> Result<Vec<FoundShip>, StoreError> {
    // Vectors of different categories are not comparable.
    let category = search.category.clone().or_else(|| Some(target.file.category.clone()));
    let all = archive
        .store
        .ships()
        .similarity_vectors(&ShipSearch { category, ..search.clone() })
        .await?;
    let name = target.name().to_owned();
    let target = CharacteristicVector::from_vessel(target, definition);
    let ranking = tokio::task::spawn_blocking(move || rank_by_correlation(all, &name, &target));
    Ok(ranking.await.map_err(sistership_store::ObjectsError::from)?)
}

/// Ranks the ships that share enough components with the target to be compared.
fn rank_by_correlation(
    all: Vec<ShipVectors>,
    name: &str,
    target: &CharacteristicVector,
) -> Vec<FoundShip> {
    let (definition, components) = (target.definition, target.normalised_components());
    let correlated = |ship: ShipVectors| {
        let values = facts::parse_vector(&ship.vectors, definition.name())?;
        let other = CharacteristicVector { definition, values };
        let correlation = components.correlation(&other.normalised_components())?;
        Some(FoundShip { value: Some(correlation), ..ship.head })
    };
    let mut found: Vec<FoundShip> =
        all.into_iter().filter(|ship| ship.head.name != name).filter_map(correlated).collect();
    found.sort_unstable_by(|a, b| compare_keys(sort_key(a), sort_key(b)));
    found
}

fn page_key(ship: &FoundShip) -> ShipKey {
    (ship.value, ship.name.clone())
}

/// Borrowed key: sorting compares it many times for each ship.
fn sort_key(ship: &FoundShip) -> (Option<f64>, &str) {
    (ship.value, &ship.name)
}

/// Order by decreasing value, then by name.
fn compare_keys(a: (Option<f64>, &str), b: (Option<f64>, &str)) -> Ordering {
    let value = |value: Option<f64>| value.unwrap_or(f64::NEG_INFINITY);
    value(b.0).total_cmp(&value(a.0)).then_with(|| a.1.cmp(b.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_similar_comes_first() {
        let mut keys = [(Some(0.5), "b"), (Some(0.9), "z"), (Some(0.5), "a")];
        keys.sort_by(|a, b| compare_keys(*a, *b));
        assert_eq!(keys.map(|key| key.1).concat(), "zab");
    }
}
