//! Sign-in at an OpenID provider (OpenID Connect Core 1.0): the authorization code flow with PKCE
//! (RFC 7636), and the checks of the answers. The module knows no route and no table: it returns
//! the target of the browser, and afterwards the identity of the person.

mod admission;
mod arguments;
mod claims;
mod failure;
mod fetch;
mod identity;
mod keys;
mod metadata;
mod provider;
mod ring_keys;
mod settings;
#[cfg(feature = "testing")]
pub mod testing;
mod ticket;
mod token;

pub use admission::AdmissionRules;
pub use arguments::OpenIdArguments;
pub use failure::{Result, SignInFailure};
pub use identity::ProviderIdentity;
pub use provider::{CallbackQuery, OpenIdProvider, SignInResult, SignInStart};
pub use settings::{ProviderSettings, SettingsError};
pub use ticket::{LIFETIME_S, SignInPurpose};
