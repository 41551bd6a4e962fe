//! Credentials as they were looked up within the last second, so that a program which asks often
//! costs the database one look a second and not three a request. A right that is taken is gone at
//! once in this process, and a second later in the others.

use std::sync::Arc;
use std::time::{Duration, Instant};

use quick_cache::sync::Cache;
use sistership_auth::sha256;

use crate::acting::Principal;

/// How long something is known.
const FRESH: Duration = Duration::from_secs(1);
/// Credentials that are known.
const MANY: usize = 4096;

/// Credentials that were found right of late, by their hash.
pub struct Known(Cache<[u8; 32], (Instant, Arc<Principal>)>);

impl Default for Known {
    fn default() -> Self {
        Self(Cache::new(MANY))
    }
}

impl Known {
    /// Whoever a credential was found to stand for within the last second.
    pub fn get(&self, credential: &str) -> Option<Arc<Principal>> {
        let (at, principal) = self.0.get(&sha256(credential))?;
        (at.elapsed() < FRESH).then_some(principal)
    }

    /// Remembers whom a credential stands for.
    pub fn put(&self, credential: &str, principal: Principal) -> Arc<Principal> {
        let principal = Arc::new(principal);
        self.0.insert(sha256(credential), (Instant::now(), Arc::clone(&principal)));
        principal
    }

    /// Forgets all: somebody's rights have changed.
    pub fn forget(&self) {
        self.0.clear();
    }
}
