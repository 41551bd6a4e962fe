//! Credentials that a process holds, apart from its store.

use sistership_auth::openid::OpenIdProvider;
use sistership_auth::{FailedAttempts, SignInAttempt};
use sistership_jobs::budget;
use sistership_store::Store;
use sistership_web_support::api_key::ApiKey;
use sistership_web_support::credential_cache::CredentialCache;
use sistership_web_support::problem::Result;

use crate::compute_pool::ComputePool;

/// Memory for hashing one password, bytes.
const HASH_BYTES: u64 = 19 << 20;

/// Credentials that a process holds, apart from its store.
pub struct Credentials {
    key: Option<ApiKey>,
    people: bool,
    provider: Option<OpenIdProvider>,
    pub(crate) known: CredentialCache,
    pub(crate) attempts: FailedAttempts,
    passwords: PasswordPools,
}

/// Pools in which passwords are hashed: guesses wait for each other, not for people who sign in
/// where they have before.
struct PasswordPools {
    trusted: ComputePool,
    unknown: ComputePool,
}

/// The accounts of a store, as a process knows them.
#[derive(Clone, Copy)]
pub struct Accounts<'a> {
    pub(crate) credentials: &'a Credentials,
    pub(crate) store: &'a Store,
}

impl Credentials {
    /// Returns the credentials of a server with its one key or without, which lets `people` sign in
    /// or not, also at a provider if there is one.
    pub fn new(key: Option<&str>, people: bool, provider: Option<OpenIdProvider>) -> Self {
        let key = key.map(ApiKey::new);
        let (known, attempts) = (CredentialCache::default(), FailedAttempts::default());
        let passwords =
            PasswordPools { trusted: ComputePool::new(1), unknown: ComputePool::new(1) };
        Self { key, people, provider, known, attempts, passwords }
    }

    /// Returns the accounts of a store.
    pub fn with_store<'a>(&'a self, store: &'a Store) -> Accounts<'a> {
        Accounts { credentials: self, store }
    }

    /// The server's one key, if it has one.
    pub fn server_key(&self) -> Option<&ApiKey> {
        self.key.as_ref()
    }

    /// Returns true if people sign in.
    pub fn has_people(&self) -> bool {
        self.people
    }

    /// Returns true if callers are not identified: without a key, on this machine's own interface.
    pub fn is_open(&self) -> bool {
        self.key.is_none() && !self.people
    }

    /// The OpenID provider at which people may sign in, if there is one.
    pub fn provider(&self) -> Option<&OpenIdProvider> {
        self.provider.as_ref()
    }

    /// Compares a password in the turn of its client.
    pub(crate) async fn compare_password<T: Send + 'static>(
        &self,
        attempt: SignInAttempt<'_>,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        let pool = match self.attempts.is_known(attempt) {
            true => &self.passwords.trusted,
            false => &self.passwords.unknown,
        };
        hash_in_turn(pool, attempt.from, work).await
    }

    /// Hashes a password that a signed-in user sets.
    pub(crate) async fn hash_password<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        hash_in_turn(&self.passwords.trusted, "", work).await
    }
}

/// Waits for a turn before memory is reserved, so that requests that wait hold none.
async fn hash_in_turn<T: Send + 'static>(
    pool: &ComputePool,
    client: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T> {
    let turn = pool.wait_turn(client).await?;
    // Argon2 takes a fixed amount of memory for each hash.
    budget::reserve_for_request(HASH_BYTES).await?;
    turn.run(work).await
}

impl Accounts<'_> {
    /// Clears the cache of principals, as somebody's rights have changed.
    pub fn clear_cache(&self) {
        self.credentials.known.clear_all();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;
    use std::sync::mpsc::channel;
    use std::time::{Duration, Instant};

    use super::*;

    #[tokio::test(flavor = "multi_thread")]
    async fn guesses_do_not_delay_a_name_that_has_signed_in_before() {
        let credentials = Arc::new(Credentials::new(None, true, None));
        let ann = SignInAttempt { name: "ann", from: "10.0.0.1" };
        credentials.attempts.record_success(ann, Instant::now());
        let (release, held) = channel::<()>();
        let (guessed, begun) = (Arc::clone(&credentials), Arc::new(tokio::sync::Notify::new()));
        let tell = Arc::clone(&begun);
        let guessing = tokio::spawn(async move {
            let guess = SignInAttempt { name: "bob", from: "10.0.0.2" };
            let compare = move || {
                tell.notify_one();
                held.recv().is_ok()
            };
            guessed.compare_password(guess, compare).await.unwrap()
        });
        begun.notified().await;
        let compared = credentials.compare_password(ann, || true);
        assert!(tokio::time::timeout(Duration::from_secs(5), compared).await.unwrap().unwrap());
        release.send(()).unwrap();
        assert!(guessing.await.unwrap());
    }
}
