//! Pages of access: signing in, the user's own account, users and keys.

mod account;
mod roles;
mod sign_in;
mod users;

pub use account::{Known, account};
pub use sign_in::{Offered, leave, sign_in};
pub use users::{new_key, users};
