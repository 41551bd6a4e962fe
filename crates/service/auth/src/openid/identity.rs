//! Who the provider says is there.

use serde_json::{Map, Value};

/// Somebody whom a provider knows.
#[derive(Debug, Clone, PartialEq)]
pub struct Identity {
    /// Whose word it is.
    pub issuer: String,
    /// Who: never given to anybody else by that issuer (OpenID Connect Core 1.0, 2).
    pub subject: String,
    /// What else it says.
    pub claims: Map<String, Value>,
}

impl Identity {
    /// What people call this one, where the provider says so.
    pub fn title(&self) -> Option<&str> {
        self.claims.get("name").and_then(Value::as_str).map(str::trim).filter(|name| {
            !name.is_empty() && name.len() <= 200 && !name.contains(char::is_control)
        })
    }
}
