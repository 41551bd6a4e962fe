//! Notes about ships. They are audit entries, so that each has an author and a time, and none can
//! be changed afterwards.

use serde_json::json;

use crate::arguments::args;
use crate::audit::entries;
use crate::checks;
use crate::entry::AuditEntry;
use crate::error::{Result, StoreError};
use crate::page::{ListPage, PageRequest};
use crate::ships::{self, ShipRepository, audit_subject};
use crate::statements::{same, statements};

/// Maximum length of a note, characters.
pub const MAX_NOTE_CHARS: usize = 1000;

statements! {
    OF_SHIP = entries!("subject = $1 AND action = 'ship.note' AND number < COALESCE($2, \
        9223372036854775807) ORDER BY number DESC LIMIT $3");
}

/// A note about a ship.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShipNote {
    /// The number of its entry in the audit.
    pub number: i64,
    /// Time of creation, microseconds since 1970.
    pub at_us: i64,
    /// Author.
    pub actor: String,
    /// Text of the note.
    pub text: String,
}

impl ShipNote {
    fn from_entry(entry: AuditEntry) -> Self {
        let AuditEntry { number, at_us, actor, state_after, .. } = entry;
        let text = state_after
            .and_then(|after| serde_json::from_str::<serde_json::Value>(&after).ok())
            .and_then(|after| after["text"].as_str().map(str::to_owned));
        Self { number, at_us, actor, text: text.unwrap_or_default() }
    }
}

impl ShipRepository<'_> {
    /// Lists the notes about a ship, the latest first; the cursor is the number of the entry.
    pub async fn list_notes(
        &self,
        name: &str,
        page: &PageRequest<i64>,
    ) -> Result<ListPage<ShipNote, i64>> {
        let (subject, limit) = (audit_subject(name), page.fetch_limit()?);
        let values = args![subject: &subject, after: page.after, limit: limit];
        let entries: Vec<AuditEntry> = self.0.database().fetch_all(OF_SHIP, values).await?;
        let notes = entries.into_iter().map(ShipNote::from_entry).collect();
        Ok(page.build_page(notes, |note: &ShipNote| note.number))
    }

    /// Adds a note to a ship, of at most [`MAX_NOTE_CHARS`] characters.
    pub async fn add_note(&self, name: &str, text: &str) -> Result<()> {
        checks::check_text("text", text)?;
        if text.trim().is_empty() || text.chars().count() > MAX_NOTE_CHARS {
            let message = format!("must have 1 to {MAX_NOTE_CHARS} characters");
            return Err(StoreError::invalid("text", message));
        }
        let mut tx = self.0.begin().await?;
        ships::find_ship(&mut tx, name).await?;
        let after = json!({ "text": text });
        tx.record_audit_event(self.0.now_us(), "ship.note", audit_subject(name), None, Some(after));
        tx.commit().await
    }
}
