//! Entries of the audit, and the hash by which each holds the one before it.

use serde_json::Value;

use crate::actor::Actor;
use crate::objects::sha256_hex;
use crate::record::record;

/// What is to be entered when the transaction is kept.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
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
        /// 1, 2, 3, ...
        pub number: i64,
        /// When.
        pub at_us: i64,
        /// Who.
        pub actor: String,
        /// From where.
        pub origin: String,
        /// What: `ship.create`, `alias.move`, ...
        pub action: String,
        /// To what: `ship:NAME`, `version:SHIP/NUMBER`, `user:NAME`, ...
        pub subject: String,
        /// What was true of it before, JSON; none where it was not there.
        pub state_before: Option<String>,
        /// What is true of it since, JSON; none where it is gone.
        pub state_after: Option<String>,
        /// The hash of the entry before; empty for the first.
        pub previous_sha256: String,
        /// The hash of all of the above.
        pub sha256: String,
    }
}

impl Entry {
    /// Something that the present actor does.
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

    /// The entry in its place, with its hash.
    pub(crate) fn numbered(self, number: i64, previous_sha256: String) -> AuditEntry {
        let mut entry = AuditEntry {
            number,
            at_us: self.at_us,
            actor: self.actor.name,
            origin: self.actor.origin,
            action: self.action.to_owned(),
            subject: self.subject,
            state_before: self.before,
            state_after: self.after,
            previous_sha256,
            sha256: String::new(),
        };
        entry.sha256 = entry.hash();
        entry
    }
}

impl AuditEntry {
    /// The SHA-256 of everything in the entry but this hash: of a JSON list of its fields, in their
    /// order, so that none can be taken for a part of another.
    pub fn hash(&self) -> String {
        let fields = serde_json::json!([
            self.number,
            self.at_us,
            self.actor,
            self.origin,
            self.action,
            self.subject,
            self.state_before,
            self.state_after,
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
        let entry = Entry::new(7, "alias.move", "alias:a/b".into(), None, after);
        let entry = entry.numbered(3, "x".into());
        assert_eq!(entry.sha256, entry.hash());
        let changes: [fn(&mut AuditEntry); 9] = [
            |entry| entry.number += 1,
            |entry| entry.at_us += 1,
            |entry| entry.actor.push('a'),
            |entry| entry.origin.push('a'),
            |entry| entry.action.push('a'),
            |entry| entry.subject.push('a'),
            |entry| entry.state_before = Some(String::new()),
            |entry| entry.state_after = None,
            |entry| entry.previous_sha256.push('a'),
        ];
        for change in changes {
            let mut changed = entry.clone();
            change(&mut changed);
            assert_ne!(changed.hash(), entry.sha256, "{changed:?}");
        }
    }
}
