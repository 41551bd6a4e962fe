//! What is known of a ship: her particulars, the vectors by which ships are similar, and the metrics of her champion.

use std::collections::BTreeMap;
use std::sync::Arc;

use sistership_identify::similarity::{CharacteristicVector, Definition};
use sistership_model::{Vessel, Zoo, particulars};
use sistership_store::{Ship, ShipFacts, StoreError, Waiting};

use super::{fact, metrics};
use crate::archive::{Archive, document, vessel};
use crate::derive::DeriveError;
use crate::problem::Problem;
use crate::publish::{CHAMPION, publish};
use crate::version::VersionDocument;

/// Vectors as they are stored: components by name, by definition.
pub(super) type Vectors = BTreeMap<String, BTreeMap<String, f64>>;

/// The facts of a ship; none where she is deleted. What does not read is told and left out: it must not keep others waiting.
pub(super) async fn of_ship(archive: &Archive, laws: &Arc<Zoo>, waiting: Waiting) -> Result<ShipFacts, StoreError> {
    let ship = match archive.store.ships().get(&waiting.ship).await {
        Err(StoreError::NotFound { .. }) => return Ok(ShipFacts::none(waiting)),
        other => other?,
    };
    let vessel = match vessel(&ship.name, &ship.document) {
        Ok(vessel) => vessel,
        Err(error) => {
            tracing::error!(ship = %ship.name, %error, "a ship does not read and is found by name and category only");
            return Ok(ShipFacts { category: ship.category, ..ShipFacts::none(waiting) });
        }
    };
    published(archive, laws, &vessel, &ship).await?;
    let champion = champion(archive, &ship.name).await?;
    let laws = Arc::clone(laws);
    let known = tokio::task::spawn_blocking(move || (known(&vessel, champion.as_ref(), &laws), vectors(&vessel)));
    let (facts, vectors) = known.await.map_err(sistership_store::ObjectsError::from)?;
    Ok(ShipFacts { waiting, category: ship.category, facts, vectors })
}

/// Makes the versions that her document publishes, where whoever wrote it was stopped before that.
async fn published(archive: &Archive, laws: &Zoo, vessel: &Vessel, ship: &Ship) -> Result<(), StoreError> {
    if let Err(Problem { detail, .. }) = publish(&archive.store, laws, vessel, &ship.document).await {
        tracing::error!(ship = %ship.name, %detail, "the published models of a ship could not be made versions");
    }
    Ok(())
}

async fn champion(archive: &Archive, ship: &str) -> Result<Option<VersionDocument>, StoreError> {
    let alias = match archive.store.aliases().get(ship, CHAMPION).await {
        Err(StoreError::NotFound { .. }) => return Ok(None),
        other => other?,
    };
    let version = archive.store.versions().get(ship, alias.version_number).await?;
    Ok(document(&version).inspect_err(|error: &DeriveError| tracing::error!(%error, "a champion has no metrics")).ok())
}

fn known(vessel: &Vessel, champion: Option<&VersionDocument>, laws: &Zoo) -> Vec<(String, f64)> {
    let particulars = particulars::names().filter_map(|name| Some((fact("particular", name), vessel.particular(name)?)));
    let metrics = champion.map_or_else(Vec::new, |champion| metrics::metrics(champion, laws));
    particulars.chain(metrics.into_iter().map(|(name, value)| (fact("metric", name), value))).collect()
}

fn vectors(vessel: &Vessel) -> String {
    let of = |definition: Definition| (definition.name().to_owned(), CharacteristicVector::of(vessel, definition).values);
    serde_json::to_string(&Definition::ALL.map(of).into_iter().collect::<Vectors>()).unwrap_or_else(|_| "{}".to_owned())
}
