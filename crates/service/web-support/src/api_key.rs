//! The server's API key, of which only the hash is stored, and the token of forms.

use sha2::{Digest as _, Sha256};
use sistership_auth::{constant_time_eq, hash_text, to_hex};
use uuid::Uuid;

/// An API key, as its hash.
#[derive(Clone, Copy)]
pub struct ApiKey([u8; 32]);

impl ApiKey {
    /// Creates the stored form of a key.
    pub fn new(key: &str) -> Self {
        Self(hash_text(key))
    }

    /// Returns true if this is the key, in a time that does not depend on the position of a
    /// difference.
    pub fn matches_key(&self, presented: &str) -> bool {
        constant_time_eq(&self.0, &hash_text(presented))
    }
}

/// Token that forms of pages send, so that no other web site can send them: it cannot read a page
/// of this server. With an API key it is derived from the key, so that every server with that key
/// accepts it; without one it is random. A signed-in user has another one, see `api::web::form`.
pub struct FormToken(String);

impl FormToken {
    /// Creates the token of a server with this key, or without one.
    pub fn from_key(key: Option<&ApiKey>) -> Self {
        let mut hash = Sha256::new_with_prefix("sistership form ");
        match key {
            Some(ApiKey(key)) => hash.update(key),
            // Each has 32 random bits at least (RFC 9562, 5.7).
            None => (0..8).for_each(|_| hash.update(Uuid::now_v7())),
        }
        Self(to_hex(&hash.finalize()))
    }

    /// Returns the token.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_key_opens() {
        let key = ApiKey::new("secret");
        assert!(key.matches_key("secret") && !key.matches_key("secre") && !key.matches_key(""));
        assert_eq!(
            FormToken::from_key(Some(&key)).as_str(),
            FormToken::from_key(Some(&key)).as_str()
        );
        assert_ne!(FormToken::from_key(None).as_str(), FormToken::from_key(None).as_str());
    }
}
