//! The page of the audit log.

use askama::Template;
use serde_json::Value;
use sistership_jobs::Archive;
use sistership_store::{AuditEntry, AuditFilter, PageRequest};

use crate::cursor::{decode_cursor, encode_cursor};
use crate::date::format_date;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::{has_word, say, say_word};
use crate::shell::PageShell;

/// Number of entries on one page.
const ENTRIES: i64 = 50;
/// Length of an id (RFC 9562).
const ID_CHARS: usize = 36;

#[derive(Template)]
#[template(path = "audit.html")]
struct AuditPage {
    shell: PageShell,
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
    /// What was done, in words.
    sentence: String,
    subject: String,
    /// Kind of the subject.
    kind: String,
    before: String,
    after: String,
}

/// Returns the page, the latest entry first; `actor` or `subject` filter.
///
/// # Errors
/// Returns an error if a field is wrong or the store fails.
pub async fn audit_page(archive: &Archive, shell: PageShell, query: &FormFields) -> Result<String> {
    let (actor, subject) = (query.get_text("actor"), query.get_text("subject"));
    // The store filters by one of the two only.
    let filter = match (actor, subject) {
        (Some(_), Some(_)) => {
            return Err(PageError::invalid_field("subject", say("audit-only-one")));
        }
        (Some(actor), None) => AuditFilter::Actor(actor),
        (None, Some(subject)) => AuditFilter::Subject(subject),
        (None, None) => AuditFilter::All,
    };
    let page = PageRequest { after: decode_cursor(query.get_text("after"))?, limit: ENTRIES };
    let list = archive.store.audit().list(filter, &page).await?;
    let next = encode_cursor(list.next.as_ref());
    let page = AuditPage {
        shell: shell.at_place("/audit"),
        actor: actor.unwrap_or_default().to_owned(),
        subject: subject.unwrap_or_default().to_owned(),
        entries: list.items.into_iter().map(EntryRow::from_entry).collect(),
        next,
    };
    Ok(page.render()?)
}

/// Returns an entry in words: `created the ship kcs` of `ship.create` and `ship:kcs`. A subject
/// whose name is an id has the name of its state.
fn action_words(action: &str, subject: &str, state: &Value) -> String {
    let (kind, id) = subject.split_once(':').unwrap_or(("", subject));
    let name = subject_name(id, state);
    let (noun, verb) = action.split_once('.').unwrap_or(("", action));
    let sentence = match has_word("audit-verb", verb) {
        true if kind == noun || kind.is_empty() => say("audit-of-subject"),
        true => say("audit-of-other"),
        false => say("audit-unknown-verb"),
    };
    let (verb, noun) = (say_word("audit-verb", verb), say_word("audit-noun", noun));
    let kind = say_word("audit-subject", kind);
    sentence.with("verb", verb).with("noun", noun).with("kind", kind).with("name", name).into()
}

/// Name of a subject for people: where it is an id, its name, title or kind, and its ship.
fn subject_name(id: &str, state: &Value) -> String {
    let is_id = id.len() == ID_CHARS && id.bytes().filter(|byte| *byte == b'-').count() == 4;
    let text = |name: &str| state[name].as_str();
    let own = ["name", "title", "kind", "verdict"].into_iter().find_map(text);
    match (is_id, own, text("ship")) {
        (true, Some(own), Some(ship)) => {
            say("audit-name-of-ship").with("own", own).with("ship", ship).into()
        }
        (true, Some(own), None) => own.to_owned(),
        (true, None, Some(ship)) => say("audit-of-ship").with("ship", ship).into(),
        _ => id.to_owned(),
    }
}

impl EntryRow {
    fn from_entry(entry: AuditEntry) -> Self {
        let AuditEntry { number, at_us, actor, origin, action, subject, .. } = entry;
        let (before, after) = (entry.state_before, entry.state_after);
        let state = after.as_deref().or(before.as_deref());
        let state = state.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default();
        Self {
            number,
            at: format_date(at_us),
            actor,
            origin,
            sentence: action_words(&action, &subject, &state),
            kind: subject.split(':').next().unwrap_or_default().to_owned(),
            subject,
            before: before.unwrap_or_default(),
            after: after.unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn entries_read_as_sentences() {
        let words = |action, subject| action_words(action, subject, &Value::Null);
        assert_eq!(words("ship.create", "ship:kcs"), "created the ship kcs");
        assert_eq!(words("alias.move", "alias:kcs/champion"), "moved the alias kcs/champion");
        assert_eq!(words("roles.set", "user:ann"), "set the roles of user ann");
        let state = json!({ "name": "turn.csv", "ship": "kcs" });
        let trial = "trial:01a227a8-faf3-7733-be81-0f54c0096a3e";
        let told = action_words("trial.create", trial, &state);
        assert_eq!(told, "created the trial turn.csv of kcs");
    }
}
