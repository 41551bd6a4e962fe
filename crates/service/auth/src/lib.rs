//! Access control: roles, their scopes, and the decision; service keys, passwords and other
//! secrets, of which only hashes are stored. The crate knows no route, no table and no ship.

mod attempts;
mod grant;
mod guessable;
mod key;
mod names;
pub mod openid;
mod password;
mod rights;
mod role;
mod secret;
mod signature;

pub use attempts::{FailedAttempts, SignInAttempt};
pub use grant::{Grant, Scope};
pub use key::{KeyText, ServiceKey};
pub use names::{check_name, is_reserved_name};
pub use password::{PasswordError, check_password, hash_password, verify_password, verify_unknown};
pub use rights::Rights;
pub use role::Role;
pub use secret::{constant_time_eq, hash_text, random_secret, to_hex};
pub use signature::sign_message;
