//! Claims of an ID token (OpenID Connect Core 1.0, 2).

use serde::Deserialize;
use serde_json::{Map, Value};

/// The claims of an ID token.
#[derive(Debug, Deserialize)]
pub(crate) struct TokenClaims {
    pub iss: String,
    pub sub: String,
    pub aud: TokenAudience,
    pub azp: Option<String>,
    pub nonce: Option<String>,
    /// All other claims.
    #[serde(flatten)]
    pub others: Map<String, Value>,
}

/// Audience of a token.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(crate) enum TokenAudience {
    One(String),
    Several(Vec<String>),
}

impl TokenAudience {
    /// Returns the clients for which the token is meant.
    pub fn client_ids(&self) -> &[String] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Several(several) => several,
        }
    }
}
