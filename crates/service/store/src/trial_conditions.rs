//! Conditions of trials as people state them: date, place, weather, loading, instruments. They are
//! audit entries, so that each statement has an author and a time; the latest one of a trial counts.

use serde_json::Value;

use crate::arguments::args;
use crate::audit::entries;
use crate::entry::AuditEntry;
use crate::error::{Result, StoreError};
use crate::statements::{same, statements};
use crate::trials::{TrialRepository, audit_subject};

statements! {
    LATEST = entries!("subject = $1 AND action = 'trial.conditions' ORDER BY number DESC LIMIT 1");
}

impl TrialRepository<'_> {
    /// Returns the latest statement about a trial, a JSON object; `None` if there is none.
    pub async fn stated_conditions(&self, id: &str) -> Result<Option<Value>> {
        let subject = format!("trial:{id}");
        let entry: Option<AuditEntry> =
            self.0.database().fetch_optional(LATEST, args![subject: &subject]).await?;
        let after = entry.and_then(|entry| entry.state_after);
        // Written by `state_conditions` below, always as JSON.
        Ok(after.and_then(|text| serde_json::from_str(&text).ok()))
    }

    /// States the conditions of several trials of a ship, of all or of none. What was stated before
    /// no longer counts.
    pub async fn state_conditions(
        &self,
        ship: &str,
        ids: &[String],
        conditions: &Value,
    ) -> Result<()> {
        let mut subjects = Vec::with_capacity(ids.len());
        for id in ids {
            let trial = self.get(id).await?;
            // The caller's rights are those for the ship.
            if trial.ship != ship {
                return Err(StoreError::not_found("trial", id));
            }
            subjects.push(audit_subject(&trial));
        }
        let mut tx = self.0.begin().await?;
        for subject in subjects {
            let after = Some(conditions.clone());
            tx.record_audit_event(self.0.now_us(), "trial.conditions", subject, None, after);
        }
        tx.commit().await
    }
}
