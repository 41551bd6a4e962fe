//! Ships of a family whose model is no longer valid.

use serde::Serialize;
use sistership_store::PageRequest;
use utoipa::ToSchema;

use super::drift::Drift;
use crate::archive::Archive;
use crate::condition::{Condition, ModelValidity};
use crate::error::DeriveError;
use crate::search::urgency::UrgencyClass;

/// Members of a family, the one with the least valid model first.
#[derive(Debug, Serialize, ToSchema)]
pub struct FamilyDrift {
    /// Its name.
    pub family: String,
    /// Number of members.
    pub members: i64,
    /// The members that were examined.
    pub ships: Vec<MemberDrift>,
}

/// Validity of the model of a member.
#[derive(Debug, Serialize, ToSchema)]
pub struct MemberDrift {
    /// The ship.
    pub ship: String,
    /// The verdict of all diagnoses of its champion, with the effects that it lacks.
    pub condition: Condition,
    /// Unexplained force of its champion on its trials over time.
    pub drift: Option<Drift>,
}

impl FamilyDrift {
    /// Examines the members whose model is not valid by diagnosis, and the first others up to
    /// `limit`.
    ///
    /// # Errors
    /// Returns an error if there is no such family, if the store does not answer, or if a document
    /// is damaged.
    pub async fn read_members(
        archive: &Archive,
        name: &str,
        limit: i64,
    ) -> Result<Self, DeriveError> {
        let families = archive.store.families();
        let family = families.get(name).await?;
        let faulty = UrgencyClass::DoesNotHold.class_range();
        // Found by the index of facts; the condition below is read anew and may have changed.
        let drifted = families.members_in_range(&family.name, &faulty, limit).await?;
        let others =
            families.list_members(&family.name, &PageRequest::first_page(limit)).await?.items;
        let known: std::collections::BTreeSet<String> =
            drifted.iter().map(|member| member.ship.clone()).collect();
        let others = others.into_iter().filter(|member| !known.contains(&member.ship));
        let mut ships = Vec::new();
        for member in drifted.into_iter().chain(others).take(usize::try_from(limit).unwrap_or(0)) {
            let condition = Condition::read_current(&archive.store, &member.ship).await?;
            let drift = Drift::for_champion(archive, &member.ship).await?;
            ships.push(MemberDrift { ship: member.ship, condition, drift });
        }
        // Invalid models first, then by decreasing drift.
        ships.sort_by(|a, b| {
            b.severity().0.cmp(&a.severity().0).then(b.severity().1.total_cmp(&a.severity().1))
        });
        Ok(Self {
            members: families.count_members(&family.name).await?,
            family: family.name,
            ships,
        })
    }
}

impl MemberDrift {
    /// Sort key: invalidity of the model by diagnosis, then its largest drift ratio.
    fn severity(&self) -> (bool, f64) {
        let worst = self.drift.as_ref().and_then(|drift| drift.worst);
        (self.condition.model == ModelValidity::DoesNotHold, worst.unwrap_or(0.0))
    }
}
