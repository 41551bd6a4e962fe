//! The page of the user's own account.

use askama::Template;
use sistership_store::Identity;

use crate::error::Result;
use crate::shell::Shell;

#[derive(Template)]
#[template(path = "account.html")]
struct AccountPage<'a> {
    shell: Shell,
    name: &'a str,
    roles: Vec<String>,
    known: Known<'a>,
    notice: Option<&'a str>,
}

/// Identities of a user at OpenID providers.
#[derive(Debug, Clone, Default)]
pub struct Known<'a> {
    /// The identities.
    pub identities: Vec<Identity>,
    /// Provider with which the account can be linked, if there is one.
    pub provider: Option<&'a str>,
}

/// Returns the page; `notice` reports an action that was just completed.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn account(
    shell: Shell,
    name: &str,
    roles: Vec<String>,
    known: Known<'_>,
    notice: Option<&str>,
) -> Result<String> {
    let shell = shell.at("/account");
    Ok(AccountPage { shell, name, roles, known, notice }.render()?)
}
