//! The audit log: changes with their authors, the latest first, and the check that no entry was
//! changed afterwards.

use crate::arguments::args;
use crate::chain::AuditHead;
use crate::entry::AuditEntry;
use crate::error::Result;
use crate::integrity::IntegrityFault;
use crate::page::{ListPage, PageRequest};
use crate::statements::{same, statements};
use crate::store::Store;

/// Number of entries that are read and checked at a time.
const BATCH_SIZE: i64 = 1000;

/// The columns of an entry.
macro_rules! entries {
    ($which:literal) => {
        same(concat!(
            "SELECT number, at_us, actor, origin, action, subject, state_before, state_after, \
             row_sha256, previous_sha256, sha256 FROM audit WHERE ",
            $which
        ))
    };
}

pub(crate) use entries;

statements! {
    LIST = entries!("number < COALESCE($1, 9223372036854775807) ORDER BY number DESC LIMIT $2");
    LIST_ACTOR = entries!("actor = $3 AND number < COALESCE($1, 9223372036854775807) ORDER BY \
        number DESC LIMIT $2");
    LIST_SUBJECT = entries!("subject = $3 AND number < COALESCE($1, 9223372036854775807) ORDER BY \
        number DESC LIMIT $2");
    FOLLOWING = entries!("number > $1 AND number <= $2 ORDER BY number LIMIT $3");
    HEAD = same("SELECT number, sha256 FROM audit_head WHERE one = 1");
    BEYOND = entries!("number > $1 ORDER BY number LIMIT 1");
}

/// Selection of audit entries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AuditFilter<'a> {
    /// All entries.
    All,
    /// Entries of one author.
    Actor(&'a str),
    /// Entries about one subject, such as `ship:NAME`.
    Subject(&'a str),
}

/// Repository of audit entries.
#[derive(Debug, Clone, Copy)]
pub struct AuditLog<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the audit log.
    pub fn audit(&self) -> AuditLog<'_> {
        AuditLog(self)
    }
}

impl AuditLog<'_> {
    /// Lists entries, the latest first; the cursor is the number of the entry.
    pub async fn list(
        &self,
        filter: AuditFilter<'_>,
        page: &PageRequest<i64>,
    ) -> Result<ListPage<AuditEntry, i64>> {
        let (database, limit) = (self.0.database(), page.fetch_limit()?);
        // A statement for each filter, so that each uses an index.
        let of = |statement, whom| async move {
            database.fetch_all(statement, args![after: page.after, limit: limit, whom: whom]).await
        };
        let entries = match filter {
            AuditFilter::All => {
                database.fetch_all(LIST, args![after: page.after, limit: limit]).await?
            }
            AuditFilter::Actor(actor) => of(LIST_ACTOR, actor).await?,
            AuditFilter::Subject(subject) => of(LIST_SUBJECT, subject).await?,
        };
        Ok(page.build_page(entries, |entry: &AuditEntry| entry.number))
    }

    /// Returns number and hash of the last entry, as they are stored in a row of their own. A copy
    /// of both that is kept elsewhere shows later if entries up to that number were replaced.
    pub async fn chain_head(&self) -> Result<AuditHead> {
        let head = self.0.database().fetch_optional(HEAD, &[]).await?;
        Ok(head.unwrap_or(AuditHead { number: 0, sha256: String::new() }))
    }

    /// Verifies the hash chain: finds entries that were changed, removed, inserted, or cut off at
    /// the end. Entries may be added meanwhile. `kept` is a head that was kept elsewhere: its entry
    /// must be there unchanged, which also detects a chain that was computed anew or cut with its
    /// head. Returns also the number of entries.
    pub async fn find_faults(
        &self,
        kept: Option<&AuditHead>,
    ) -> Result<(i64, Vec<IntegrityFault>)> {
        let head = self.chain_head().await?;
        let (mut faults, mut last) = (Vec::new(), AuditHead { number: 0, sha256: String::new() });
        loop {
            // The head was read first: entries that are added while this runs lie beyond it and are
            // not judged.
            let values = args![after: last.number, until: head.number, limit: BATCH_SIZE];
            let entries: Vec<AuditEntry> = self.0.database().fetch_all(FOLLOWING, values).await?;
            if entries.is_empty() {
                break;
            }
            for entry in entries {
                faults.extend(
                    entry_fault(&last, &entry).map(|message| chain_fault(entry.number, message)),
                );
                last = AuditHead { number: entry.number, sha256: entry.sha256 };
                if let Some(kept) = kept.filter(|kept| kept.number == last.number) {
                    faults.extend(kept_fault(kept, &last));
                }
            }
        }
        faults.extend(self.check_end(&head, &last).await?);
        if let Some(kept) = kept.filter(|kept| kept.number > last.number) {
            faults.extend(kept_fault(kept, &last));
        }
        Ok((head.number, faults))
    }

    /// Checks that the list ends with the entry that the head names.
    async fn check_end(
        &self,
        head: &AuditHead,
        last: &AuditHead,
    ) -> Result<Option<IntegrityFault>> {
        if last != head {
            let message = format!(
                "the last entry is number {}, but this one is recorded as the last",
                last.number
            );
            return Ok(Some(chain_fault(head.number, message)));
        }
        let beyond: Option<AuditEntry> =
            self.0.database().fetch_optional(BEYOND, args![number: head.number]).await?;
        match beyond {
            // The head has advanced, so the entry was added since the head was read.
            Some(_) if self.chain_head().await?.number > head.number => Ok(None),
            Some(entry) => Ok(Some(chain_fault(
                entry.number,
                "comes after the entry that is recorded as the last".into(),
            ))),
            None => Ok(None),
        }
    }
}

/// Returns the fault of an entry that follows `last`, if there is one: its number, the hash of its
/// predecessor, or its own hash.
fn entry_fault(last: &AuditHead, entry: &AuditEntry) -> Option<String> {
    let expected = last.number + 1;
    if entry.number != expected {
        return Some(format!("comes after number {}: {expected} is missing", last.number));
    }
    if entry.previous_sha256 != last.sha256 {
        return Some("does not contain the hash of the previous entry".to_owned());
    }
    (entry.content_hash() != entry.sha256).then(|| {
        format!(
            "its content has the hash {}, but {} is recorded",
            entry.content_hash(),
            entry.sha256
        )
    })
}

/// Returns the fault of a chain that does not have the entry of a head that was kept elsewhere.
fn kept_fault(kept: &AuditHead, last: &AuditHead) -> Option<IntegrityFault> {
    let message = match (kept.number > last.number, kept.sha256 == last.sha256) {
        (true, _) => format!("is missing: the last entry is number {}", last.number),
        (false, false) => "is not the one whose hash was kept".to_owned(),
        (false, true) => return None,
    };
    Some(IntegrityFault::new("audit-head", format!("audit entry {}", kept.number), message))
}

fn chain_fault(number: i64, message: String) -> IntegrityFault {
    IntegrityFault::new("audit-chain", format!("audit entry {number}"), message)
}
