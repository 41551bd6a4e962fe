//! The server's API key, of which only the hash is kept, and the token of forms.

use sha2::{Digest as _, Sha256};
use sistership_auth::{hex, same, sha256};
use uuid::Uuid;

/// An API key, as its hash.
#[derive(Clone, Copy)]
pub struct ApiKey([u8; 32]);

impl ApiKey {
    /// What is kept of a key.
    pub fn new(key: &str) -> Self {
        Self(sha256(key))
    }

    /// Whether this is the key, in a time that does not tell how much of it is right.
    pub fn is(&self, presented: &str) -> bool {
        same(&self.0, &sha256(presented))
    }
}

/// What forms of pages send along, so that no other web site can send them: it cannot read a page
/// of this server. With a key it follows from the key, so that every server with that key takes it;
/// without one it is drawn at the start. Who is signed in has another, see `web::form`.
pub struct FormToken(String);

impl FormToken {
    /// Of a server with this key, or without one.
    pub fn of(key: Option<&ApiKey>) -> Self {
        let mut hash = Sha256::new_with_prefix("sistership form ");
        match key {
            Some(ApiKey(key)) => hash.update(key),
            // Each has 32 random bits at least (RFC 9562, 5.7).
            None => (0..8).for_each(|_| hash.update(Uuid::now_v7())),
        }
        Self(hex(&hash.finalize()))
    }

    /// The token.
    pub fn text(&self) -> &str {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_key_opens() {
        let key = ApiKey::new("secret");
        assert!(key.is("secret") && !key.is("secre") && !key.is(""));
        assert_eq!(FormToken::of(Some(&key)).text(), FormToken::of(Some(&key)).text());
        assert_ne!(FormToken::of(None).text(), FormToken::of(None).text());
    }
}
