//! Recent changes of ships, trials and models, as people made them: a part of the audit that every
//! reader may see.

use serde_json::Value;

use crate::arguments::args;
use crate::audit::entries;
use crate::entry::AuditEntry;
use crate::error::Result;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    // The newest 5000 entries, so that the cost does not grow with the audit. The program's own
    // entries publish the library.
    RECENT = entries!("number > COALESCE((SELECT number FROM audit_head WHERE one = 1), 0) - 5000 \
        AND at_us >= $1 AND actor <> 'sistership' AND action IN ('ship.create', 'trial.create', \
        'version.create', 'alias.move', 'diagnosis.create') ORDER BY number DESC LIMIT 500");
}

/// Kind of a change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChangeKind {
    /// The ship was added.
    ShipAdded,
    /// A trial was uploaded.
    TrialUploaded,
    /// A version was made.
    VersionMade(i64),
    /// A version became champion.
    Promoted(i64),
    /// A diagnosis was made, with this verdict.
    Diagnosed(String),
}

/// Change of a ship.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShipChange {
    /// Name of the ship.
    pub ship: String,
    /// What was changed.
    pub kind: ChangeKind,
    /// Time, microseconds since 1970.
    pub at_us: i64,
}

impl Store {
    /// Lists the changes since a time, microseconds since 1970, the latest first; at most 500 of
    /// the newest 5000 entries of the audit.
    pub async fn recent_changes(&self, since_us: i64) -> Result<Vec<ShipChange>> {
        let entries: Vec<AuditEntry> =
            self.database().fetch_all(RECENT, args![at_us: since_us]).await?;
        Ok(entries.into_iter().filter_map(ShipChange::from_entry).collect())
    }
}

impl ShipChange {
    fn from_entry(entry: AuditEntry) -> Option<Self> {
        let after = serde_json::from_str::<Value>(entry.state_after.as_deref()?).ok()?;
        let (_, name) = entry.subject.split_once(':')?;
        // Versions and aliases are named by their ship first.
        let (first, rest) = name.split_once('/').unwrap_or((name, ""));
        let named = |name: &str| after[name].as_str().map(str::to_owned);
        let (ship, kind) = match entry.action.as_str() {
            "ship.create" => (name.to_owned(), ChangeKind::ShipAdded),
            "trial.create" => (named("ship")?, ChangeKind::TrialUploaded),
            "version.create" => (first.to_owned(), ChangeKind::VersionMade(rest.parse().ok()?)),
            "alias.move" if rest == "champion" => {
                (first.to_owned(), ChangeKind::Promoted(after["version"].as_i64()?))
            }
            "diagnosis.create" => (named("ship")?, ChangeKind::Diagnosed(named("verdict")?)),
            _ => return None,
        };
        Some(Self { ship, kind, at_us: entry.at_us })
    }
}
