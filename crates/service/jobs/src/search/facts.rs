//! Searchable facts of a ship: its particulars, its characteristic vectors, the metrics of its
//! champion and the validity of that.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Deserializer;
use serde::de::{DeserializeSeed, IgnoredAny, MapAccess, Visitor};
use sistership_model::{Vessel, Zoo, particulars};
use sistership_priors::similarity::{CharacteristicVector, VectorDefinition};
use sistership_store::{Ship, ShipFacts, StaleShip, StoreError, Version};

use super::metrics;
use super::position;
use super::query::fact_name;
use super::urgency;
use crate::aliases::CHAMPION;
use crate::archive::{Archive, parse_vessel, version_document};
use crate::error::DeriveError;
use crate::publish::publish_models;
use crate::version::VersionDocument;

/// Vectors as they are stored: components by name, by definition.
type StoredVectors = BTreeMap<String, BTreeMap<String, f64>>;

/// Ship as it was read, from which its facts are computed.
struct ShipContent {
    waiting: StaleShip,
    category: String,
    vessel: Option<Vessel>,
    champion: Option<VersionDocument>,
    /// Facts about the validity of its champion, and its position.
    standing: Vec<(String, f64)>,
}

/// Computes the facts of ships on all cores: manoeuvres may have to be simulated for them.
pub(super) async fn compute_facts(
    archive: &Archive,
    laws: &Arc<Zoo>,
    waiting: Vec<StaleShip>,
) -> Result<Vec<ShipFacts>, StoreError> {
    // Reading is asynchronous and in order; only the computation is parallel.
    let mut ships = Vec::with_capacity(waiting.len());
    for ship in waiting {
        ships.push(read_content(archive, laws, ship).await?);
    }
    let laws = Arc::clone(laws);
    let known = tokio::task::spawn_blocking(move || {
        ships.into_par_iter().map(|ship| ship.into_facts(&laws)).collect()
    });
    Ok(known.await.map_err(sistership_store::ObjectsError::from)?)
}

/// Reads a ship; without content if it was deleted. A ship that cannot be parsed is logged and has
/// no facts: it must not block the others.
async fn read_content(
    archive: &Archive,
    laws: &Zoo,
    waiting: StaleShip,
) -> Result<ShipContent, StoreError> {
    let nothing = |waiting: StaleShip, category: String| ShipContent {
        waiting,
        category,
        vessel: None,
        champion: None,
        standing: Vec::new(),
    };
    // A deleted ship gets an entry without facts.
    let ship = match archive.store.ships().get(&waiting.ship).await {
        Err(StoreError::NotFound { .. }) => return Ok(nothing(waiting, String::new())),
        other => other?,
    };
    let vessel = match parse_vessel(&ship.name, &ship.document) {
        Ok(vessel) => vessel,
        Err(error) => {
            tracing::error!(ship = %ship.name, %error, "a ship cannot be parsed and can be found \
                                                        by name and category only");
            return Ok(nothing(waiting, ship.category));
        }
    };
    // Publication comes first: it may make the champion that the next line reads.
    publish_missing(archive, laws, &vessel, &ship).await?;
    let champion = read_champion(archive, &ship.name).await?;
    let mut standing = urgency::urgency_facts(archive, &ship.name, champion.as_ref()).await?;
    standing.extend(position::position_facts(archive, &ship.name).await?);
    Ok(ShipContent { waiting, category: ship.category, vessel: Some(vessel), champion, standing })
}

impl ShipContent {
    fn into_facts(self, laws: &Zoo) -> ShipFacts {
        let Self { waiting, category, vessel, champion, standing } = self;
        match vessel {
            None => ShipFacts { category, ..ShipFacts::without_facts(waiting) },
            Some(vessel) => {
                let mut facts = ship_facts(&vessel, champion.as_ref(), laws);
                facts.extend(standing);
                let vectors = vectors_to_json(&vessel);
                ShipFacts { waiting, category, facts, vectors }
            }
        }
    }
}

/// Creates the versions that the ship's document publishes, in case the process that stored it was
/// stopped before that.
async fn publish_missing(
    archive: &Archive,
    laws: &Zoo,
    vessel: &Vessel,
    ship: &Ship,
) -> Result<(), StoreError> {
    if let Err(error) = publish_models(&archive.store, laws, vessel, &ship.document).await {
        tracing::error!(ship = %ship.name, %error, "the published models of a ship could not be \
                                                    stored as versions");
    }
    Ok(())
}

async fn read_champion(
    archive: &Archive,
    ship: &str,
) -> Result<Option<VersionDocument>, StoreError> {
    let alias = match archive.store.aliases().get(ship, CHAMPION).await {
        Err(StoreError::NotFound { .. }) => return Ok(None),
        other => other?,
    };
    let version = archive.store.versions().get(ship, alias.version_number).await?;
    Ok(document_with_weights(archive, &version)
        .await
        // A damaged champion costs its metrics, not the entry of the ship.
        .inspect_err(|error: &DeriveError| tracing::error!(%error, "a champion has no metrics"))
        .ok())
}

/// Returns a version's document with the weights of its learned correction attached.
async fn document_with_weights(
    archive: &Archive,
    version: &Version,
) -> Result<VersionDocument, DeriveError> {
    let mut document = version_document(version)?;
    archive.attach_weights(&mut document.model).await?;
    Ok(document)
}

fn ship_facts(
    vessel: &Vessel,
    champion: Option<&VersionDocument>,
    laws: &Zoo,
) -> Vec<(String, f64)> {
    let particulars = particulars::particular_names()
        .filter_map(|name| Some((fact_name("particular", name), vessel.particular(name)?)));
    let metrics =
        champion.map_or_else(Vec::new, |champion| metrics::version_metrics(champion, laws));
    particulars
        .chain(metrics.into_iter().map(|(name, value)| (fact_name("metric", name), value)))
        .collect()
}

fn vectors_to_json(vessel: &Vessel) -> String {
    let of = |definition: VectorDefinition| {
        (definition.name().to_owned(), CharacteristicVector::from_vessel(vessel, definition).values)
    };
    serde_json::to_string(&VectorDefinition::ALL.map(of).into_iter().collect::<StoredVectors>())
        .unwrap_or_else(|_| "{}".to_owned())
}

/// Parses the vector of one definition and skips the others, because thousands of ships are
/// compared.
pub(super) fn parse_vector(stored: &str, definition: &str) -> Option<BTreeMap<String, f64>> {
    VectorSelector(definition).deserialize(&mut serde_json::Deserializer::from_str(stored)).ok()?
}

struct VectorSelector<'a>(&'a str);

impl<'de> DeserializeSeed<'de> for VectorSelector<'_> {
    type Value = Option<BTreeMap<String, f64>>;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<Self::Value, D::Error> {
        from.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for VectorSelector<'_> {
    type Value = Option<BTreeMap<String, f64>>;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("vectors by definition")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut found = None;
        while let Some(name) = map.next_key::<String>()? {
            // Values of other definitions are skipped without allocation.
            match name == self.0 {
                true => found = Some(map.next_value()?),
                false => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_vector_is_read_among_several() {
        let stored = r#"{"a":{"x":[1,{}]},"b":{"y":0.1,"z":2}}"#;
        let expected = BTreeMap::from([("y".to_owned(), 0.1), ("z".to_owned(), 2.0)]);
        assert_eq!(
            (parse_vector(stored, "b"), parse_vector(stored, "c"), parse_vector(stored, "a")),
            (Some(expected), None, None)
        );
    }
}
