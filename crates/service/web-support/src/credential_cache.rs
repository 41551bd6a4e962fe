//! Cache of credentials for one second, so that a program with many requests costs the database one
//! lookup a second instead of three for each request. A revoked right is gone at once in this
//! process, and a second later in others.

use std::sync::Arc;
use std::time::{Duration, Instant};

use quick_cache::sync::Cache;
use sistership_auth::hash_text;

use crate::acting::Principal;

/// Maximum age of an entry.
const FRESH: Duration = Duration::from_secs(1);
/// Maximum number of entries.
const MANY: usize = 4096;

/// Recently verified credentials, by their hash.
pub struct CredentialCache(Cache<[u8; 32], (Instant, Arc<Principal>)>);

impl Default for CredentialCache {
    fn default() -> Self {
        Self(Cache::new(MANY))
    }
}

impl CredentialCache {
    /// Returns the principal of a credential that was verified within the last second.
    pub fn get(&self, credential: &str) -> Option<Arc<Principal>> {
        // The hash is the key, so that the cache holds no credential.
        let (at, principal) = self.0.get(&hash_text(credential))?;
        (at.elapsed() < FRESH).then_some(principal)
    }

    /// Adds the principal of a credential.
    pub fn insert_principal(&self, credential: &str, principal: Principal) -> Arc<Principal> {
        let principal = Arc::new(principal);
        self.0.insert(hash_text(credential), (Instant::now(), Arc::clone(&principal)));
        principal
    }

    /// Removes all entries, after a change of rights.
    pub fn clear_all(&self) {
        self.0.clear();
    }
}
