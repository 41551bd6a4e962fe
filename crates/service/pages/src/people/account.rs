//! One's own account.

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

/// As whom providers know somebody.
#[derive(Debug, Clone, Default)]
pub struct Known<'a> {
    /// As these.
    pub identities: Vec<Identity>,
    /// The provider that an account can be linked with, if there is one.
    pub provider: Option<&'a str>,
}

/// The page; `notice` is what has just been done.
///
/// # Errors
/// The page cannot be written.
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
