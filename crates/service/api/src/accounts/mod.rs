//! Who is known to a server: users, service keys and sessions, how somebody shows who they are, and
//! who of those that an OpenID provider knows gets in. It knows no route.

mod credentials;
mod grants;
mod identify;
mod provided;
mod users;

pub use credentials::{Accounts, Credentials};
pub use identify::{COOKIE, Refusal, cookie};
pub use provided::Outcome;
pub use users::SESSION;
