//! How entries come into the audit: as the last statements of the transaction that they tell of.
//! Whoever adds some holds the row of the last one until the commit, so that entries have an order;
//! as nothing is waited for after that, no two can wait for each other.

use crate::arguments::args;
use crate::connections::DatabaseTransaction;
use crate::entry::Entry;
use crate::error::Result;
use crate::record::record;
use crate::statements::{same, statements};

statements! {
    // Takes the numbers, and the lock; the hash is still that of the entry before.
    TAKE = same("INSERT INTO audit_head (one, number, sha256) VALUES (1, $1, '') \
        ON CONFLICT (one) DO UPDATE SET number = audit_head.number + $1 RETURNING number, sha256");
    ENTER = same("INSERT INTO audit (number, at_us, actor, origin, action, subject, state_before, \
        state_after, previous_sha256, sha256) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10)");
    LAST = same("UPDATE audit_head SET sha256 = $1 WHERE one = 1");
}

record! {
    /// The last entry.
    pub struct AuditHead {
        /// Its number; 0 where there is none.
        pub number: i64,
        /// Its hash.
        pub sha256: String,
    }
}

/// Enters what a transaction has done.
pub(crate) async fn enter(tx: &mut DatabaseTransaction, entries: Vec<Entry>) -> Result<()> {
    let Ok(count) = i64::try_from(entries.len()) else { return Ok(()) };
    if count == 0 {
        return Ok(());
    }
    let AuditHead { number, mut sha256 } = tx.one(TAKE, args![count: count]).await?;
    for (number, entry) in (number - count + 1..).zip(entries) {
        let entry = entry.numbered(number, sha256);
        let values = args![number: number, at_us: entry.at_us, actor: &entry.actor,
            origin: &entry.origin,
            action: &entry.action, subject: &entry.subject, state_before: &entry.state_before,
            state_after: &entry.state_after, previous_sha256: &entry.previous_sha256,
            sha256: &entry.sha256];
        tx.execute(ENTER, values).await?;
        sha256 = entry.sha256;
    }
    tx.execute(LAST, args![sha256: &sha256]).await.map(drop)
}
