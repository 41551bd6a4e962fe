//! For tests: a provider that says what it is told to, and one that others have written.

mod hostile;
mod real;

pub use hostile::{CLIENT, Hostile, Told, now_s};
pub use real::RealProvider;

use crate::openid::settings::Settings;

/// Settings with the secret of a client, as if a file had held it.
#[must_use]
pub fn with_secret(settings: Settings, secret: &str) -> Settings {
    Settings { client_secret: Some(secret.to_owned()), ..settings }
}
