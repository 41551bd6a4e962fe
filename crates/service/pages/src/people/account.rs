//! The page of the user's own account.

use askama::Template;
use sistership_store::IdentityRow;

use super::roles::role_words;
use crate::error::Result;
use crate::shell::PageShell;

#[derive(Template)]
#[template(path = "account.html")]
struct AccountPage<'a> {
    shell: PageShell,
    name: &'a str,
    roles: Vec<String>,
    known: LinkedIdentities<'a>,
    notice: Option<&'a str>,
}

/// Identities of a user at OpenID providers.
#[derive(Debug, Clone, Default)]
pub struct LinkedIdentities<'a> {
    /// The identities.
    pub identities: Vec<IdentityRow>,
    /// Provider with which the account can be linked, if there is one.
    pub provider: Option<&'a str>,
}

/// Returns the page; `roles` are in the notation of forms, `notice` reports an action that was just
/// completed.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn account_page(
    shell: PageShell,
    name: &str,
    roles: Vec<String>,
    known: LinkedIdentities<'_>,
    notice: Option<&str>,
) -> Result<String> {
    let shell = shell.at_place("/account");
    let roles = roles.iter().map(|role| role_words(role)).collect();
    Ok(AccountPage { shell, name, roles, known, notice }.render()?)
}
