//! Ships of a family whose model no longer holds.

use serde::Serialize;
use sistership_store::Page;
use utoipa::ToSchema;

use super::drift::Drift;
use crate::archive::Archive;
use crate::condition::{Condition, Standing};
use crate::error::DeriveError;
use crate::search::standing::Class;

/// The members of a family, the one whose model holds least first.
#[derive(Debug, Serialize, ToSchema)]
pub struct FamilyDrift {
    /// Its name.
    pub family: String,
    /// How many members it has.
    pub members: i64,
    /// Those that were looked at.
    pub ships: Vec<MemberDrift>,
}

/// How the model of a member holds.
#[derive(Debug, Serialize, ToSchema)]
pub struct MemberDrift {
    /// The ship.
    pub ship: String,
    /// What all diagnoses of its champion say: the effects that it lacks.
    pub condition: Condition,
    /// What its champion leaves of its trials over time.
    pub drift: Option<Drift>,
}

impl FamilyDrift {
    /// Of the members whose diagnosis says that they do not hold, and of the first others up to
    /// `limit`.
    ///
    /// # Errors
    /// There is no such family, the store does not answer, or a document is damaged.
    pub async fn of(archive: &Archive, name: &str, limit: i64) -> Result<Self, DeriveError> {
        let families = archive.store.families();
        let family = families.get(name).await?;
        let faulty = Class::DoesNotHold.range();
        let drifted = families.within(&family.name, &faulty, limit).await?;
        let others = families.members(&family.name, &Page::first(limit)).await?.items;
        let known: std::collections::BTreeSet<String> =
            drifted.iter().map(|member| member.ship.clone()).collect();
        let others = others.into_iter().filter(|member| !known.contains(&member.ship));
        let mut ships = Vec::new();
        for member in drifted.into_iter().chain(others).take(usize::try_from(limit).unwrap_or(0)) {
            let condition = Condition::of(&archive.store, &member.ship).await?;
            let drift = Drift::of(archive, &member.ship).await?;
            ships.push(MemberDrift { ship: member.ship, condition, drift });
        }
        ships.sort_by(|a, b| {
            b.worse().0.cmp(&a.worse().0).then(b.worse().1.total_cmp(&a.worse().1))
        });
        Ok(Self { members: families.count(&family.name).await?, family: family.name, ships })
    }
}

impl MemberDrift {
    /// Whether the diagnosis says that its model does not hold, and how much more it leaves of what
    /// is new.
    fn worse(&self) -> (bool, f64) {
        let worst = self.drift.as_ref().and_then(|drift| drift.worst);
        (self.condition.model == Standing::DoesNotHold, worst.unwrap_or(0.0))
    }
}
