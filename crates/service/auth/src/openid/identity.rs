//! Identity of a person at a provider.

use serde_json::{Map, Value};

/// Identity of a person at a provider.
#[derive(Debug, Clone, PartialEq)]
pub struct ProviderIdentity {
    /// Issuer URL of the provider.
    pub issuer: String,
    /// Subject, never reassigned by that issuer (OpenID Connect Core 1.0, 2).
    pub subject: String,
    /// Other claims.
    pub claims: Map<String, Value>,
}

impl ProviderIdentity {
    /// Returns the display name of the person, if the provider sends a valid one.
    pub fn display_name(&self) -> Option<&str> {
        self.claims.get("name").and_then(Value::as_str).map(str::trim).filter(|name| {
            !name.is_empty() && name.len() <= 200 && !name.contains(char::is_control)
        })
    }
}
