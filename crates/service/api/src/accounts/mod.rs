//! Accounts of a server: users, service keys and sessions, identification of callers, and admission
//! of those whom an OpenID provider knows. This module knows no route.

mod credentials;
mod grants;
mod identify;
mod provided;
mod users;

pub use credentials::{Accounts, Credentials};
pub use identify::{IdentityRefusal, SESSION_COOKIE, find_cookie};
pub use provided::SignInOutcome;
pub use users::SESSION_LIFETIME;
