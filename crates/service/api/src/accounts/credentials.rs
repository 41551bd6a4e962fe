//! Credentials that a process holds, apart from its store.

use std::sync::Arc;

use sistership_auth::FailedAttempts;
use sistership_auth::openid::OpenIdProvider;
use sistership_jobs::budget;
use sistership_store::Store;
use sistership_web_support::api_key::ApiKey;
use sistership_web_support::credential_cache::CredentialCache;
use sistership_web_support::problem::{Problem, Result};
use tokio::sync::Semaphore;

/// Credentials that a process holds, apart from its store.
pub struct Credentials {
    key: Option<ApiKey>,
    people: bool,
    provider: Option<OpenIdProvider>,
    pub(crate) known: CredentialCache,
    pub(crate) attempts: FailedAttempts,
    /// Permits for the passwords that are hashed at a time.
    seats: Arc<Semaphore>,
}

/// The accounts of a store, as a process knows them.
#[derive(Clone, Copy)]
pub struct Accounts<'a> {
    pub(crate) credentials: &'a Credentials,
    pub(crate) store: &'a Store,
}

impl Credentials {
    /// Returns the credentials of a server with its one key or without, which lets `people` sign in
    /// or not, also at a provider if there is one. Passwords are hashed under permits of `seats`.
    pub fn new(
        key: Option<&str>,
        people: bool,
        provider: Option<OpenIdProvider>,
        seats: Arc<Semaphore>,
    ) -> Self {
        let key = key.map(ApiKey::new);
        let (known, attempts) = (CredentialCache::default(), FailedAttempts::default());
        Self { key, people, provider, known, attempts, seats }
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

    /// Computes a hash on a blocking thread.
    pub(crate) async fn run_blocking<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        // A request that is dropped while it waits gives its place up.
        let seat = Arc::clone(&self.seats).acquire_owned().await.map_err(Problem::internal)?;
        let task = tokio::task::spawn_blocking(budget::with_request_memory(move || {
            let _seat = seat;
            work()
        }));
        task.await.map_err(Problem::internal)
    }
}

impl Accounts<'_> {
    /// Clears the cache of principals, as somebody's rights have changed.
    pub fn clear_cache(&self) {
        self.credentials.known.clear_all();
    }
}
