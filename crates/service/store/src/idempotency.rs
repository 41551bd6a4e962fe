//! Requests that must not be carried out twice, by the key that the caller gave them.

use std::time::Duration;

use crate::arguments::args;
use crate::checks;
use crate::clock::micros;
use crate::database::Transaction;
use crate::error::{Result, StoreError};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// After this long without an answer, whoever carried a request out is taken for dead.
pub const TAKE_OVER_AFTER: Duration = Duration::from_secs(60);
/// How often who carries a request out tells that it still does.
pub const PROLONG_EVERY: Duration = Duration::from_secs(15);
/// How long an answer is kept for replay.
pub const KEEP_KEYS: Duration = Duration::from_secs(7 * 24 * 3600);

statements! {
    INSERT = same("INSERT INTO idempotency_keys (scope, key, request_sha256, created_us) VALUES \
        ($1, $2, $3, $4) ON CONFLICT (scope, key) DO NOTHING");
    GET = same("SELECT request_sha256, status, response, created_us FROM idempotency_keys WHERE \
        scope = $1 AND key = $2");
    TAKE_OVER = same("UPDATE idempotency_keys SET created_us = $3, alive_us = NULL \
        WHERE scope = $1 AND key = $2 AND status IS NULL AND COALESCE(alive_us, created_us) <= $4");
    PROLONG = same("UPDATE idempotency_keys SET alive_us = $4 \
        WHERE scope = $1 AND key = $2 AND created_us = $3 AND status IS NULL");
    FINISH = same("UPDATE idempotency_keys SET status = $4, response = $5 \
        WHERE scope = $1 AND key = $2 AND created_us = $3 AND status IS NULL");
    ABANDON = same("DELETE FROM idempotency_keys WHERE scope = $1 AND key = $2 AND created_us = $3 \
        AND status IS NULL");
    PURGE = same("DELETE FROM idempotency_keys WHERE created_us < $1");
}

record! {
    /// A key as it is kept.
    pub struct KeyEntry {
        /// What was asked.
        pub request_sha256: String,
        /// The status that was answered.
        pub status: Option<i64>,
        /// The body that was answered.
        pub response: Option<String>,
        /// When it began.
        pub created_us: i64,
    }
}

/// The right to carry a request out, until somebody takes it over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ticket {
    scope: String,
    key: String,
    began_us: i64,
}

/// What to do with a request that carries a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Begun {
    /// Carry it out in a [unit of work](crate::UnitOfWork::keep) that keeps the answer, or
    /// [abandon](Idempotency::abandon) it.
    New(Ticket),
    /// Another is carrying it out right now.
    InProgress,
    /// It was carried out; give this answer again.
    Replay {
        /// The HTTP status.
        status: i64,
        /// The body.
        body: String,
    },
    /// The key was used for another request.
    Mismatch,
}

/// The idempotency keys of a store.
#[derive(Debug, Clone, Copy)]
pub struct Idempotency<'a>(pub(crate) &'a Store);

impl Store {
    /// Requests that must not be carried out twice.
    pub fn idempotency(&self) -> Idempotency<'_> {
        Idempotency(self)
    }
}

impl Idempotency<'_> {
    /// Begins a request. `scope` is its method and path.
    pub async fn begin(&self, scope: &str, key: &str, request_sha256: &str) -> Result<Begun> {
        checks::sha256("request_sha256", request_sha256)?;
        checks::name("key", key)?;
        let now = self.0.now_us();
        let mut tx = self.0.begin().await?;
        let values = args![scope: scope, key: key, request_sha256: request_sha256, created_us: now];
        let begun = match tx.execute(INSERT, values).await? {
            0 => again(&mut tx, scope, key, request_sha256, now).await?,
            _ => Begun::New(ticket(scope, key, now)),
        };
        tx.commit().await?;
        Ok(begun)
    }

    /// Tells that a request is still being carried out, so that nobody takes it over for
    /// [`TAKE_OVER_AFTER`] from now. A conflict when somebody has.
    pub async fn prolong(&self, ticket: &Ticket) -> Result<()> {
        let Ticket { scope, key, began_us } = ticket;
        let values =
            args![scope: scope, key: key, created_us: *began_us, alive_us: self.0.now_us()];
        let mut tx = self.0.begin().await?;
        let prolonged = tx.execute(PROLONG, values).await?;
        tx.commit().await?;
        if prolonged == 0 { Err(taken_over(key)) } else { Ok(()) }
    }

    /// Forgets a request that came to nothing, so that it can be tried again.
    pub async fn abandon(&self, ticket: &Ticket) -> Result<()> {
        let Ticket { scope, key, began_us } = ticket;
        let mut tx = self.0.begin().await?;
        tx.execute(ABANDON, args![scope: scope, key: key, created_us: *began_us]).await?;
        tx.commit().await
    }

    /// Forgets the keys that are older than [`KEEP_KEYS`] and returns their number.
    pub async fn purge(&self) -> Result<u64> {
        let mut tx = self.0.begin().await?;
        let purged =
            tx.execute(PURGE, args![created_us: self.0.now_us() - micros(KEEP_KEYS)]).await?;
        tx.commit().await?;
        Ok(purged)
    }
}

/// Keeps the answer to a request for replay, within the transaction of its work.
pub(crate) async fn answered(
    tx: &mut Transaction,
    ticket: &Ticket,
    status: i64,
    body: &str,
) -> Result<()> {
    let Ticket { scope, key, began_us } = ticket;
    let values =
        args![scope: scope, key: key, created_us: *began_us, status: status, response: body];
    match tx.execute(FINISH, values).await? {
        0 => Err(taken_over(key)),
        _ => Ok(()),
    }
}

fn taken_over(key: &str) -> StoreError {
    StoreError::conflict(
        "idempotency key",
        key,
        "the request has been taken over by another; repeat it for its answer",
    )
}

/// What to do with a key that is there already.
async fn again(
    tx: &mut Transaction,
    scope: &str,
    key: &str,
    request_sha256: &str,
    now: i64,
) -> Result<Begun> {
    let entry: Option<KeyEntry> = tx.optional(GET, args![scope: scope, key: key]).await?;
    Ok(match entry {
        // It was abandoned between two statements; the caller comes again.
        None => Begun::InProgress,
        Some(entry) if entry.request_sha256 != request_sha256 => Begun::Mismatch,
        Some(KeyEntry { status: Some(status), response, .. }) => {
            Begun::Replay { status, body: response.unwrap_or_default() }
        }
        Some(_) => take_over(tx, scope, key, now).await?,
    })
}

async fn take_over(tx: &mut Transaction, scope: &str, key: &str, now: i64) -> Result<Begun> {
    let values =
        args![scope: scope, key: key, created_us: now, before_us: now - micros(TAKE_OVER_AFTER)];
    Ok(match tx.execute(TAKE_OVER, values).await? {
        0 => Begun::InProgress,
        _ => Begun::New(ticket(scope, key, now)),
    })
}

fn ticket(scope: &str, key: &str, began_us: i64) -> Ticket {
    Ticket { scope: scope.to_owned(), key: key.to_owned(), began_us }
}
