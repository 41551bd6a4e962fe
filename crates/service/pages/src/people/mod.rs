//! Pages of access: signing in, the user's own account, users and keys.

mod account;
mod roles;
mod sign_in;
mod users;
mod webhooks;

pub use account::{LinkedIdentities, account_page};
pub use sign_in::{ProviderLink, leave_page, sign_in_page};
pub use users::{new_key_page, users_page};
pub use webhooks::{new_webhook_page, webhook_request, webhooks_page};
