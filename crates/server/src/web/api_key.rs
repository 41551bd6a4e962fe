//! The API key, of which only the hash is kept, and the token of forms.

use sha2::{Digest as _, Sha256};
use uuid::Uuid;

/// An API key, as its hash.
#[derive(Clone, Copy)]
pub(crate) struct ApiKey([u8; 32]);

impl ApiKey {
    pub(crate) fn new(key: &str) -> Self {
        Self(Sha256::digest(key.as_bytes()).into())
    }

    /// Whether this is the key, in a time that does not tell how much of it is right.
    pub(super) fn is(&self, presented: &str) -> bool {
        let presented: [u8; 32] = Sha256::digest(presented.as_bytes()).into();
        let difference = self.0.iter().zip(presented).fold(0, |all, (a, b)| all | (a ^ b));
        std::hint::black_box(difference) == 0
    }
}

/// What forms of pages send along, so that no other web site can send them: it cannot read a page of
/// this server. With a key it follows from the key, so that every server with that key takes it;
/// without one it is drawn at the start.
pub(crate) struct FormToken(String);

impl FormToken {
    pub(crate) fn of(key: Option<&ApiKey>) -> Self {
        let mut hash = Sha256::new_with_prefix("sistership form ");
        match key {
            Some(ApiKey(key)) => hash.update(key),
            // Each has 32 random bits at least (RFC 9562, 5.7).
            None => (0..8).for_each(|_| hash.update(Uuid::now_v7())),
        }
        Self(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
    }

    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// Whether this is the token, in a time that does not tell how much of it is right.
    pub(super) fn is(&self, presented: &str) -> bool {
        ApiKey::new(&self.0).is(presented)
    }
}
