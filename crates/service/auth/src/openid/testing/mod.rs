//! Providers for tests: one with configurable answers, and an independent implementation.

mod hostile;
mod real;

pub use hostile::{CLIENT, Hostile, Told, now_s};
pub use real::RealProvider;

use crate::openid::settings::Settings;

/// Returns settings with a client secret, as if it were read from a file.
#[must_use]
pub fn with_secret(settings: Settings, secret: &str) -> Settings {
    Settings { client_secret: Some(secret.to_owned()), ..settings }
}
