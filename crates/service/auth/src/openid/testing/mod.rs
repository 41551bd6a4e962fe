//! Providers for tests: one with configurable answers, and an independent implementation.

mod real;
mod scripted;

pub use real::RealProvider;
pub use scripted::{CLIENT, ProviderScript, ScriptedProvider, now_s};

use crate::openid::settings::ProviderSettings;

/// Returns settings with a client secret, as if it were read from a file.
#[must_use]
pub fn with_secret(settings: ProviderSettings, secret: &str) -> ProviderSettings {
    ProviderSettings { client_secret: Some(secret.to_owned()), ..settings }
}
