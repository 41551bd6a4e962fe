//! Appending of audit entries, as the last statements of the transaction that they describe. The
//! writer holds the row of the last entry until the commit, which gives the entries an order; as it
//! waits for nothing else after that, no deadlock is possible.

use crate::arguments::args;
use crate::connections::DatabaseTransaction;
use crate::entry::NewAuditEntry;
use crate::error::Result;
use crate::record::record;
use crate::row_seal;
use crate::statements::{same, statements};

statements! {
    // Reserves `$1` numbers and locks the row; the hash is still that of the entry before.
    TAKE = same("INSERT INTO audit_head (one, number, sha256) VALUES (1, $1, '') \
        ON CONFLICT (one) DO UPDATE SET number = audit_head.number + $1 RETURNING number, sha256");
    ENTER = same("INSERT INTO audit (number, at_us, actor, origin, action, subject, state_before, \
        state_after, row_sha256, previous_sha256, sha256) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, \
        $9, $10, $11)");
    LAST = same("UPDATE audit_head SET sha256 = $1 WHERE one = 1");
}

record! {
    /// Number and hash of the last audit entry.
    pub struct AuditHead {
        /// Number of the entry; 0 if there is none.
        pub number: i64,
        /// Its hash.
        pub sha256: String,
    }
}

/// Appends the entries of a transaction to the hash chain.
pub(crate) async fn append_entries(
    tx: &mut DatabaseTransaction,
    entries: Vec<NewAuditEntry>,
) -> Result<()> {
    let Ok(count) = i64::try_from(entries.len()) else { return Ok(()) };
    if count == 0 {
        return Ok(());
    }
    let AuditHead { number, mut sha256 } = tx.fetch_one(TAKE, args![count: count]).await?;
    // `number` is the last one reserved; the first one of this transaction is `number - count + 1`.
    for (number, entry) in (number - count + 1..).zip(entries) {
        // Under the lock of the head, so that seals follow each other as the changes do.
        let seal = row_seal::seal_subject(tx, &entry.subject).await?;
        let entry = entry.with_number(number, seal, sha256);
        let values = args![number: number, at_us: entry.at_us, actor: &entry.actor,
            origin: &entry.origin,
            action: &entry.action, subject: &entry.subject, state_before: &entry.state_before,
            state_after: &entry.state_after, row_sha256: &entry.row_sha256, previous_sha256: &entry.previous_sha256,
            sha256: &entry.sha256];
        tx.execute(ENTER, values).await?;
        // The next entry refers to this hash.
        sha256 = entry.sha256;
    }
    tx.execute(LAST, args![sha256: &sha256]).await.map(drop)
}
