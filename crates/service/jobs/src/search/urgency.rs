//! Priority of ships for attention, as facts by which they are listed.

use serde_json::Value;
use sistership_store::{FactRange, PageRequest, StoreError};

use crate::archive::Archive;
use crate::condition::{Condition, ModelValidity};
use crate::fleet::residuals_of_newest;
use crate::published_ships::is_published;
use crate::version::VersionDocument;

/// Fact that orders ships by urgency: by class, and within a class by decreasing error.
pub const URGENCY_FACT: &str = "standing order";
/// Fact with the error of a ship's champion on held-out manoeuvres.
pub const ERROR_FACT: &str = "standing error";

/// Fact that counts the ships of the fleet by urgency: [`URGENCY_FACT`] without the library.
pub const FLEET_FACT: &str = "fleet order";
/// Fact that tells the ships of the fleet, 1, from those of the library, 0.
const OWN_FACT: &str = "own";

/// Prefix of the facts with the unexplained force of a champion on the newest trials of its ship,
/// oldest first.
pub const RESIDUAL_FACT_PREFIX: &str = "standing left of trial ";
/// Largest number of these trials.
const MAX_RESIDUAL_TRIALS: usize = 24;

/// Urgency class of a ship, most urgent first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UrgencyClass {
    /// A diagnosis found that something is missing from its champion.
    DoesNotHold,
    /// Its champion was never diagnosed.
    Unknown,
    /// It has no model yet.
    NoModel,
    /// The residual of its champion is explained by the measurement noise.
    Holds,
}

impl UrgencyClass {
    /// Every class, most urgent first.
    pub const ALL: [Self; 4] = [Self::DoesNotHold, Self::Unknown, Self::NoModel, Self::Holds];

    /// Returns the class of a ship in this condition.
    pub fn from_condition(condition: &Condition) -> Self {
        match (condition.model, condition.version) {
            (ModelValidity::DoesNotHold, _) => Self::DoesNotHold,
            (ModelValidity::Holds, _) => Self::Holds,
            (ModelValidity::Unknown, Some(_)) => Self::Unknown,
            (ModelValidity::Unknown, None) => Self::NoModel,
        }
    }

    /// Returns the class of a ship from its value of [`URGENCY_FACT`] or [`FLEET_FACT`].
    pub fn from_order(order: f64) -> Self {
        let class = Self::ALL.into_iter().rfind(|class| f64::from(*class as u8) <= order);
        class.unwrap_or(Self::DoesNotHold)
    }

    /// Returns its name in URLs.
    pub fn name(self) -> &'static str {
        match self {
            Self::DoesNotHold => "does-not-hold",
            Self::Unknown => "unknown",
            Self::NoModel => "no-model",
            Self::Holds => "holds",
        }
    }

    /// Returns the class with this name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|class| class.name() == name)
    }

    /// Returns the range of the ships of this class, in their order.
    pub fn class_range(self) -> FactRange {
        let first = f64::from(self as u8);
        FactRange { fact: URGENCY_FACT.to_owned(), min: first, max: first + CLASS_WIDTH }
    }

    /// Returns the range of the ships of all classes, in their order.
    pub fn full_range() -> FactRange {
        FactRange { fact: URGENCY_FACT.to_owned(), min: 0.0, max: Self::ALL.len() as f64 }
    }
}

/// Ships of the users, or published ones that the program brings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShipCollection {
    /// Ships that a user has added, and published ones with trials of their own.
    Fleet,
    /// Published ships without trials, as source models and examples.
    Library,
}

impl ShipCollection {
    /// Returns the range of its ships, all with the same value.
    pub fn fact_range(self) -> FactRange {
        let value = self.fact_value();
        FactRange { fact: OWN_FACT.to_owned(), min: value, max: value }
    }

    fn fact_value(self) -> f64 {
        match self {
            Self::Fleet => 1.0,
            Self::Library => 0.0,
        }
    }

    /// Returns the collection of a ship.
    async fn find(archive: &Archive, ship: &str) -> Result<Self, StoreError> {
        let trials = archive.store.trials().list(ship, &PageRequest::first_page(1)).await?;
        let published = is_published(ship) && trials.items.is_empty();
        Ok(if published { Self::Library } else { Self::Fleet })
    }
}

/// Part of the distance between two classes that the errors use.
const CLASS_WIDTH: f64 = 0.999;

fn urgency(class: UrgencyClass, error: Option<f64>) -> f64 {
    // The offset falls with the error: within a class the largest error comes first.
    f64::from(class as u8) + CLASS_WIDTH / (1.0 + error.unwrap_or(0.0).max(0.0))
}

/// Returns the error of a refined model on held-out manoeuvres from its report: the mean squared
/// error of the simulation divided by the variance of the measurement.
pub fn held_out_error(version: &VersionDocument) -> Option<f64> {
    let options = version.report["options"].as_array()?;
    let chosen = options.iter().find(|step| step["chosen"] == Value::Bool(true))?;
    chosen["error"].as_f64().filter(|error| error.is_finite())
}

/// Computes the facts of a ship.
pub(super) async fn urgency_facts(
    archive: &Archive,
    ship: &str,
    champion: Option<&VersionDocument>,
) -> Result<Vec<(String, f64)>, StoreError> {
    let class = UrgencyClass::from_condition(&Condition::read_current(&archive.store, ship).await?);
    let error = champion.and_then(held_out_error);
    let order = urgency(class, error);
    let collection = ShipCollection::find(archive, ship).await?;
    let facts = [
        (URGENCY_FACT, Some(order)),
        (ERROR_FACT, error),
        (OWN_FACT, Some(collection.fact_value())),
        (FLEET_FACT, (collection == ShipCollection::Fleet).then_some(order)),
    ];
    let facts = facts.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
    let left = match champion {
        Some(champion) => newest_residuals(archive, champion).await,
        None => Vec::new(),
    };
    let left = left
        .into_iter()
        .enumerate()
        .map(|(k, value)| (format!("{RESIDUAL_FACT_PREFIX}{k:02}"), value));
    Ok(facts.chain(left).collect())
}

/// Returns the unexplained forces on the newest trials; an error is logged and gives none.
async fn newest_residuals(archive: &Archive, champion: &VersionDocument) -> Vec<f64> {
    let left = residuals_of_newest(archive, champion, MAX_RESIDUAL_TRIALS).await;
    left.unwrap_or_else(|error| {
        tracing::error!(
            ship = %champion.ship, %error,
            "the unexplained force of a champion cannot be read"
        );
        Vec::new()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worse_class_is_first_and_in_it_the_larger_error() {
        let ordered = [
            urgency(UrgencyClass::DoesNotHold, Some(2.0)),
            urgency(UrgencyClass::DoesNotHold, Some(0.1)),
            urgency(UrgencyClass::DoesNotHold, None),
            urgency(UrgencyClass::Unknown, Some(1e9)),
            urgency(UrgencyClass::Holds, Some(0.1)),
        ];
        assert!(ordered.is_sorted(), "{ordered:?}");
        for class in UrgencyClass::ALL {
            let range = class.class_range();
            assert!((range.min..=range.max).contains(&urgency(class, None)));
            assert_eq!(UrgencyClass::by_name(class.name()), Some(class));
            for error in [None, Some(0.0), Some(1e9)] {
                assert_eq!(UrgencyClass::from_order(urgency(class, error)), class);
            }
        }
    }
}
