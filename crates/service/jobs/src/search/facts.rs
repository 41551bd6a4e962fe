//! What is known of a ship: its particulars, the vectors by which ships are similar, the metrics of
//! its champion, and how that stands.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Deserializer;
use serde::de::{DeserializeSeed, IgnoredAny, MapAccess, Visitor};
use sistership_model::{Vessel, Zoo, particulars};
use sistership_priors::similarity::{CharacteristicVector, Definition};
use sistership_store::{Ship, ShipFacts, StoreError, Version, Waiting};

use super::metrics;
use super::query::fact;
use super::standing;
use crate::archive::{Archive, document, vessel};
use crate::error::DeriveError;
use crate::line::CHAMPION;
use crate::publish::publish;
use crate::version::VersionDocument;

/// Vectors as they are stored: components by name, by definition.
type Vectors = BTreeMap<String, BTreeMap<String, f64>>;

/// A ship as it was read, from which its facts follow.
struct Read {
    waiting: Waiting,
    category: String,
    vessel: Option<Vessel>,
    champion: Option<VersionDocument>,
    /// How it stands.
    standing: Vec<(String, f64)>,
}

/// The facts of ships, which are computed on all cores: manoeuvres may have to be sailed for them.
pub(super) async fn of_ships(
    archive: &Archive,
    laws: &Arc<Zoo>,
    waiting: Vec<Waiting>,
) -> Result<Vec<ShipFacts>, StoreError> {
    let mut ships = Vec::with_capacity(waiting.len());
    for ship in waiting {
        ships.push(read(archive, laws, ship).await?);
    }
    let laws = Arc::clone(laws);
    let known = tokio::task::spawn_blocking(move || {
        ships.into_par_iter().map(|ship| ship.facts(&laws)).collect()
    });
    Ok(known.await.map_err(sistership_store::ObjectsError::from)?)
}

/// Reads a ship; nothing where it is deleted. What does not read is told and left out: it must not
/// keep others waiting.
async fn read(archive: &Archive, laws: &Zoo, waiting: Waiting) -> Result<Read, StoreError> {
    let nothing = |waiting: Waiting, category: String| Read {
        waiting,
        category,
        vessel: None,
        champion: None,
        standing: Vec::new(),
    };
    let ship = match archive.store.ships().get(&waiting.ship).await {
        Err(StoreError::NotFound { .. }) => return Ok(nothing(waiting, String::new())),
        other => other?,
    };
    let vessel = match vessel(&ship.name, &ship.document) {
        Ok(vessel) => vessel,
        Err(error) => {
            tracing::error!(ship = %ship.name, %error, "a ship does not read and is found by name \
                and category only");
            return Ok(nothing(waiting, ship.category));
        }
    };
    published(archive, laws, &vessel, &ship).await?;
    let champion = champion(archive, &ship.name).await?;
    let standing = standing::facts(archive, &ship.name, champion.as_ref()).await?;
    Ok(Read { waiting, category: ship.category, vessel: Some(vessel), champion, standing })
}

impl Read {
    fn facts(self, laws: &Zoo) -> ShipFacts {
        let Self { waiting, category, vessel, champion, standing } = self;
        match vessel {
            None => ShipFacts { category, ..ShipFacts::none(waiting) },
            Some(vessel) => {
                let mut facts = known(&vessel, champion.as_ref(), laws);
                facts.extend(standing);
                let vectors = vectors(&vessel);
                ShipFacts { waiting, category, facts, vectors }
            }
        }
    }
}

/// Makes the versions that its document publishes, where whoever wrote it was stopped before that.
async fn published(
    archive: &Archive,
    laws: &Zoo,
    vessel: &Vessel,
    ship: &Ship,
) -> Result<(), StoreError> {
    if let Err(error) = publish(&archive.store, laws, vessel, &ship.document).await {
        tracing::error!(ship = %ship.name, %error, "the published models of a ship could not be \
            made versions");
    }
    Ok(())
}

async fn champion(archive: &Archive, ship: &str) -> Result<Option<VersionDocument>, StoreError> {
    let alias = match archive.store.aliases().get(ship, CHAMPION).await {
        Err(StoreError::NotFound { .. }) => return Ok(None),
        other => other?,
    };
    let version = archive.store.versions().get(ship, alias.version_number).await?;
    Ok(whole(archive, &version)
        .await
        .inspect_err(|error: &DeriveError| tracing::error!(%error, "a champion has no metrics"))
        .ok())
}

/// A version's document, whose model sails.
async fn whole(archive: &Archive, version: &Version) -> Result<VersionDocument, DeriveError> {
    let mut document = document(version)?;
    archive.attach(&mut document.model).await?;
    Ok(document)
}

fn known(vessel: &Vessel, champion: Option<&VersionDocument>, laws: &Zoo) -> Vec<(String, f64)> {
    let particulars = particulars::names()
        .filter_map(|name| Some((fact("particular", name), vessel.particular(name)?)));
    let metrics = champion.map_or_else(Vec::new, |champion| metrics::metrics(champion, laws));
    particulars
        .chain(metrics.into_iter().map(|(name, value)| (fact("metric", name), value)))
        .collect()
}

fn vectors(vessel: &Vessel) -> String {
    let of = |definition: Definition| {
        (definition.name().to_owned(), CharacteristicVector::of(vessel, definition).values)
    };
    serde_json::to_string(&Definition::ALL.map(of).into_iter().collect::<Vectors>())
        .unwrap_or_else(|_| "{}".to_owned())
}

/// The vector of one definition among those that are stored. The others are passed over: ships are
/// compared by thousands.
pub(super) fn vector(stored: &str, definition: &str) -> Option<BTreeMap<String, f64>> {
    Only(definition).deserialize(&mut serde_json::Deserializer::from_str(stored)).ok()?
}

struct Only<'a>(&'a str);

impl<'de> DeserializeSeed<'de> for Only<'_> {
    type Value = Option<BTreeMap<String, f64>>;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<Self::Value, D::Error> {
        from.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Only<'_> {
    type Value = Option<BTreeMap<String, f64>>;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("vectors by definition")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut found = None;
        while let Some(name) = map.next_key::<String>()? {
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
            (vector(stored, "b"), vector(stored, "c"), vector(stored, "a")),
            (Some(expected), None, None)
        );
    }
}
