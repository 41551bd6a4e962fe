//! The page of the audit log.

use askama::Template;
use sistership_jobs::Archive;
use sistership_store::{AuditEntry, AuditFilter, Page};

use crate::cursor::{cursor, key};
use crate::date::date;
use crate::error::{PageError, Result};
use crate::form::Fields;
use crate::shell::Shell;

/// Number of entries on one page.
const ENTRIES: i64 = 50;

#[derive(Template)]
#[template(path = "audit.html")]
struct AuditPage {
    shell: Shell,
    actor: String,
    subject: String,
    entries: Vec<EntryRow>,
    next: Option<String>,
}

struct EntryRow {
    number: i64,
    at: String,
    actor: String,
    origin: String,
    action: String,
    subject: String,
    before: String,
    after: String,
}

/// Returns the page, the latest entry first; `actor` or `subject` filter.
///
/// # Errors
/// Returns an error if a field is wrong or the store fails.
pub async fn page(archive: &Archive, shell: Shell, query: &Fields) -> Result<String> {
    let (actor, subject) = (query.text("actor"), query.text("subject"));
    // The store filters by one of the two only.
    let filter = match (actor, subject) {
        (Some(_), Some(_)) => {
            return Err(PageError::invalid("subject", "choose by one of the two"));
        }
        (Some(actor), None) => AuditFilter::Actor(actor),
        (None, Some(subject)) => AuditFilter::Subject(subject),
        (None, None) => AuditFilter::All,
    };
    let page = Page { after: key(query.text("after"))?, limit: ENTRIES };
    let list = archive.store.audit().list(filter, &page).await?;
    let next = cursor(list.next.as_ref());
    let page = AuditPage {
        shell: shell.at("/audit"),
        actor: actor.unwrap_or_default().to_owned(),
        subject: subject.unwrap_or_default().to_owned(),
        entries: list.items.into_iter().map(EntryRow::of).collect(),
        next,
    };
    Ok(page.render()?)
}

impl EntryRow {
    fn of(entry: AuditEntry) -> Self {
        let AuditEntry { number, at_us, actor, origin, action, subject, .. } = entry;
        let (before, after) = (entry.state_before, entry.state_after);
        Self {
            number,
            at: date(at_us),
            actor,
            origin,
            action,
            subject,
            before: before.unwrap_or_default(),
            after: after.unwrap_or_default(),
        }
    }
}
