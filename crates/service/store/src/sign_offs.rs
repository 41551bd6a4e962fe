//! Signatures under versions: a person states to have checked or approved one. They are audit
//! entries, so that each has an author and a time, and none can be changed afterwards.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::audit::entries;
use crate::checks;
use crate::entry::AuditEntry;
use crate::error::{Result, StoreError};
use crate::statements::{same, statements};
use crate::versions::VersionRepository;

/// Roles in which a person signs.
pub const SIGN_OFF_ROLES: [&str; 2] = ["checked", "approved"];
/// Maximum length of the name of a person, characters.
const MAX_PERSON_CHARS: usize = 200;

statements! {
    // Few people sign a version; the latest signature of each role counts.
    OF_VERSION = entries!("subject = $1 AND action = 'version.sign' ORDER BY number DESC LIMIT 100");
}

/// Signature of a person under a version.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SignOff {
    /// Role, one of [`SIGN_OFF_ROLES`].
    pub role: String,
    /// Name of the person as it is written under the summary.
    pub person: String,
    /// Principal that sent it.
    pub actor: String,
    /// Time, microseconds since 1970.
    pub at_us: i64,
}

impl SignOff {
    fn from_entry(entry: AuditEntry) -> Self {
        let after = entry.state_after.and_then(|after| serde_json::from_str::<Value>(&after).ok());
        let text = |name: &str| {
            let text = after.as_ref().and_then(|after| after[name].as_str());
            text.unwrap_or_default().to_owned()
        };
        let (role, person) = (text("role"), text("person"));
        Self { role, person, actor: entry.actor, at_us: entry.at_us }
    }
}

impl VersionRepository<'_> {
    /// Lists the signatures under a version, the latest first.
    pub async fn list_sign_offs(&self, model: &str, number: i64) -> Result<Vec<SignOff>> {
        let subject = audit_subject(model, number);
        let entries: Vec<AuditEntry> =
            self.0.database().fetch_all(OF_VERSION, args![subject: &subject]).await?;
        Ok(entries.into_iter().map(SignOff::from_entry).collect())
    }

    /// Signs a version in a role of [`SIGN_OFF_ROLES`].
    pub async fn sign_off(&self, model: &str, number: i64, role: &str, person: &str) -> Result<()> {
        if !SIGN_OFF_ROLES.contains(&role) {
            let message = format!("must be one of {}", SIGN_OFF_ROLES.join(", "));
            return Err(StoreError::invalid("role", message));
        }
        checks::check_text("person", person)?;
        if person.trim().is_empty() || person.chars().count() > MAX_PERSON_CHARS {
            let message = format!("must have 1 to {MAX_PERSON_CHARS} characters");
            return Err(StoreError::invalid("person", message));
        }
        self.get_head(model, number).await?;
        let mut tx = self.0.begin().await?;
        let after = json!({ "role": role, "person": person });
        let subject = audit_subject(model, number);
        tx.record_audit_event(self.0.now_us(), "version.sign", subject, None, Some(after));
        tx.commit().await
    }
}

/// Subject of audit entries about a version.
fn audit_subject(model: &str, number: i64) -> String {
    format!("version:{model}/{number}")
}
