//! Idempotency keys: requests that must not be executed twice, identified by a key of the caller.

use std::time::Duration;

use crate::arguments::args;
use crate::checks;
use crate::clock::duration_us;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// Time without a sign of life after which the executor of a request counts as dead.
pub const TAKE_OVER_AFTER: Duration = Duration::from_secs(60);
/// Interval at which the executor of a request reports that it is alive.
pub const PROLONG_EVERY: Duration = Duration::from_secs(15);
/// Pause between two attempts to remove the key of a request that failed.
const ABANDON_EVERY: Duration = Duration::from_secs(1);
/// Time for which an answer is kept for replay.
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
    /// A stored key.
    pub struct KeyEntry {
        /// Hash of the request.
        pub request_sha256: String,
        /// HTTP status of the answer; none while the request is executed.
        pub status: Option<i64>,
        /// Body of the answer.
        pub response: Option<String>,
        /// Start of the execution, microseconds since 1970.
        pub created_us: i64,
    }
}

/// The right to execute a request, until another process takes it over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RequestTicket {
    scope: String,
    key: String,
    began_us: i64,
}

/// Decision on a request that carries a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RequestClaim {
    /// Execute it in a [unit of work](crate::UnitOfWork::keep) that stores the answer, or
    /// [abandon](Idempotency::abandon) it.
    New(RequestTicket),
    /// Another process executes it at present.
    InProgress,
    /// It was executed; return the stored answer.
    Replay {
        /// The HTTP status.
        status: i64,
        /// The body.
        body: String,
    },
    /// The key was used for another request.
    Mismatch,
}

/// Repository of idempotency keys.
#[derive(Debug, Clone, Copy)]
pub struct IdempotencyRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of idempotency keys.
    pub fn idempotency(&self) -> IdempotencyRepository<'_> {
        IdempotencyRepository(self)
    }
}

impl IdempotencyRepository<'_> {
    /// Begins a request. `scope` is its HTTP method and path.
    pub async fn begin_request(
        &self,
        scope: &str,
        key: &str,
        request_sha256: &str,
    ) -> Result<RequestClaim> {
        checks::check_sha256("request_sha256", request_sha256)?;
        checks::check_name("key", key)?;
        let now = self.0.now_us();
        let mut tx = self.0.begin().await?;
        let values = args![scope: scope, key: key, request_sha256: request_sha256, created_us: now];
        let begun = match tx.execute(INSERT, values).await? {
            0 => resolve_existing(&mut tx, scope, key, request_sha256, now).await?,
            _ => RequestClaim::New(new_ticket(scope, key, now)),
        };
        if let Err(error) = tx.commit().await {
            // Whether the key is held is not known; the request is not executed.
            if let RequestClaim::New(ticket) = begun {
                self.abandon_in_background(ticket);
            }
            return Err(error);
        }
        Ok(begun)
    }

    /// Reports that a request is still executed, so that no other process takes it over for
    /// [`TAKE_OVER_AFTER`] from now.
    ///
    /// # Errors
    /// Returns a conflict if another process has taken it over.
    pub async fn prolong_ticket(&self, ticket: &RequestTicket) -> Result<()> {
        let RequestTicket { scope, key, began_us } = ticket;
        let values =
            args![scope: scope, key: key, created_us: *began_us, alive_us: self.0.now_us()];
        let mut tx = self.0.begin().await?;
        let prolonged = tx.execute(PROLONG, values).await?;
        tx.commit().await?;
        if prolonged == 0 { Err(taken_over(key)) } else { Ok(()) }
    }

    /// Removes the key of a request that failed, so that it can be tried again.
    pub async fn abandon_ticket(&self, ticket: &RequestTicket) -> Result<()> {
        let RequestTicket { scope, key, began_us } = ticket;
        let mut tx = self.0.begin().await?;
        tx.execute(ABANDON, args![scope: scope, key: key, created_us: *began_us]).await?;
        tx.commit().await
    }

    /// Removes the key of a request that failed as soon as the database answers, unless the key
    /// expires before: the same request is refused meanwhile.
    pub fn abandon_in_background(&self, ticket: RequestTicket) {
        let store = self.0.clone();
        let abandoning = async move {
            while store.idempotency().abandon_ticket(&ticket).await.is_err() {
                tokio::time::sleep(ABANDON_EVERY).await;
            }
        };
        // Without an effect where the key has been taken over meanwhile.
        tokio::spawn(tokio::time::timeout(TAKE_OVER_AFTER, abandoning));
    }

    /// Removes the keys that are older than [`KEEP_KEYS`] and returns their number.
    pub async fn purge_expired(&self) -> Result<u64> {
        let mut tx = self.0.begin().await?;
        let purged =
            tx.execute(PURGE, args![created_us: self.0.now_us() - duration_us(KEEP_KEYS)]).await?;
        tx.commit().await?;
        Ok(purged)
    }
}

/// Stores the answer to a request for replay, within the transaction of its work.
pub(crate) async fn store_answer(
    tx: &mut AuditedTransaction,
    ticket: &RequestTicket,
    status: i64,
    body: &str,
) -> Result<()> {
    let RequestTicket { scope, key, began_us } = ticket;
    let values =
        // The start identifies the execution: after a takeover no row matches, and the work is
        // undone.
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
        "the same request is handled by another connection; repeat it to get the answer",
    )
}

/// Returns the decision for a key that exists already.
async fn resolve_existing(
    tx: &mut AuditedTransaction,
    scope: &str,
    key: &str,
    request_sha256: &str,
    now: i64,
) -> Result<RequestClaim> {
    let entry: Option<KeyEntry> = tx.fetch_optional(GET, args![scope: scope, key: key]).await?;
    Ok(match entry {
        // It was abandoned between the two statements; the caller tries again.
        None => RequestClaim::InProgress,
        // The same key for another request is an error of the caller, not a retry.
        Some(entry) if entry.request_sha256 != request_sha256 => RequestClaim::Mismatch,
        Some(KeyEntry { status: Some(status), response, .. }) => {
            RequestClaim::Replay { status, body: response.unwrap_or_default() }
        }
        Some(_) => take_over(tx, scope, key, now).await?,
    })
}

async fn take_over(
    tx: &mut AuditedTransaction,
    scope: &str,
    key: &str,
    now: i64,
) -> Result<RequestClaim> {
    let values = args![scope: scope, key: key, created_us: now, before_us: now - duration_us(TAKE_OVER_AFTER)];
    Ok(match tx.execute(TAKE_OVER, values).await? {
        0 => RequestClaim::InProgress,
        _ => RequestClaim::New(new_ticket(scope, key, now)),
    })
}

fn new_ticket(scope: &str, key: &str, began_us: i64) -> RequestTicket {
    RequestTicket { scope: scope.to_owned(), key: key.to_owned(), began_us }
}
