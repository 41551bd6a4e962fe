//! Audit entries, and the hash by which each refers to the one before it.

use serde_json::Value;

use crate::actor::Actor;
use crate::objects::sha256_hex;
use crate::record::record;

/// An audit entry that is appended when its transaction commits.
#[derive(Debug, Clone)]
pub(crate) struct NewAuditEntry {
    pub(crate) at_us: i64,
    pub(crate) actor: Actor,
    pub(crate) action: &'static str,
    pub(crate) subject: String,
    pub(crate) before: Option<String>,
    pub(crate) after: Option<String>,
}

record! {
    /// An entry of the audit.
    pub struct AuditEntry {
        /// Number of the entry: 1, 2, 3, ...
        pub number: i64,
        /// Time, microseconds since 1970.
        pub at_us: i64,
        /// Author.
        pub actor: String,
        /// Origin of the request.
        pub origin: String,
        /// Action: `ship.create`, `alias.move`, ...
        pub action: String,
        /// Subject: `ship:NAME`, `version:SHIP/NUMBER`, `user:NAME`, ...
        pub subject: String,
        /// State of the subject before, JSON; none if it did not exist.
        pub state_before: Option<String>,
        /// State of the subject after, JSON; none if it no longer exists.
        pub state_after: Option<String>,
        /// SHA-256 of the protected columns of the subject after the change, see
        /// [`crate::row_seal`].
        pub row_sha256: Option<String>,
        /// The hash of the entry before; empty for the first.
        pub previous_sha256: String,
        /// The hash of the fields above.
        pub sha256: String,
    }
}

impl NewAuditEntry {
    /// Creates an entry for an action of the present author.
    pub(crate) fn new(
        at_us: i64,
        action: &'static str,
        subject: String,
        before: Option<Value>,
        after: Option<Value>,
    ) -> Self {
        let text = |value: Option<Value>| value.map(|value| value.to_string());
        let (before, after) = (text(before), text(after));
        Self { at_us, actor: Actor::current(), action, subject, before, after }
    }

    /// Returns the entry with its number, the seal of its row, the hash of its predecessor, and its own hash.
    pub(crate) fn with_number(
        self,
        number: i64,
        row_sha256: Option<String>,
        previous_sha256: String,
    ) -> AuditEntry {
        let mut entry = AuditEntry {
            number,
            at_us: self.at_us,
            actor: self.actor.name,
            origin: self.actor.origin,
            action: self.action.to_owned(),
            subject: self.subject,
            state_before: self.before,
            state_after: self.after,
            row_sha256,
            previous_sha256,
            sha256: String::new(),
        };
        // The hash covers all other fields, so that it is computed last.
        entry.sha256 = entry.content_hash();
        entry
    }
}

impl AuditEntry {
    /// Returns the SHA-256 of all other fields, as a JSON list in their order: the list is
    /// unambiguous, a mere concatenation would not be.
    pub fn content_hash(&self) -> String {
        let fields = serde_json::json!([
            self.number,
            self.at_us,
            self.actor,
            self.origin,
            self.action,
            self.subject,
            self.state_before,
            self.state_after,
            self.row_sha256,
            self.previous_sha256,
        ]);
        sha256_hex(fields.to_string().as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_in_the_hash() {
        let after = Some(serde_json::json!({ "version": 2 }));
        let entry = NewAuditEntry::new(7, "alias.move", "alias:a/b".into(), None, after);
        let entry = entry.with_number(3, None, "x".into());
        assert_eq!(entry.sha256, entry.content_hash());
        let changes: [fn(&mut AuditEntry); 10] = [
            |entry| entry.number += 1,
            |entry| entry.at_us += 1,
            |entry| entry.actor.push('a'),
            |entry| entry.origin.push('a'),
            |entry| entry.action.push('a'),
            |entry| entry.subject.push('a'),
            |entry| entry.state_before = Some(String::new()),
            |entry| entry.state_after = None,
            |entry| entry.row_sha256 = Some(String::new()),
            |entry| entry.previous_sha256.push('a'),
        ];
        for change in changes {
            let mut changed = entry.clone();
            change(&mut changed);
            assert_ne!(changed.content_hash(), entry.sha256, "{changed:?}");
        }
    }
}
