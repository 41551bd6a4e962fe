//! One's own account.

use askama::Template;

use crate::error::Result;
use crate::shell::Shell;

#[derive(Template)]
#[template(path = "account.html")]
struct AccountPage {
    shell: Shell,
    name: String,
    roles: Vec<String>,
    changed: bool,
}

/// The page; `changed` says that the password has just been.
///
/// # Errors
/// The page cannot be written.
pub fn account(shell: Shell, name: &str, roles: Vec<String>, changed: bool) -> Result<String> {
    let shell = shell.at("/account");
    Ok(AccountPage { shell, name: name.to_owned(), roles, changed }.render()?)
}
