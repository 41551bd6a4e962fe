//! The sign-in page.

use askama::Template;

use crate::error::Result;
use crate::shell::Shell;

#[derive(Template)]
#[template(path = "sign_in.html")]
struct SignInPage<'a> {
    shell: Shell,
    next: &'a str,
    why_not: Option<&'a str>,
    provider: Option<Offered<'a>>,
}

/// A provider at which people may sign in.
#[derive(Debug, Clone, Copy)]
pub struct Offered<'a> {
    /// Display name.
    pub title: &'a str,
    /// Address of its sign-in.
    pub place: &'a str,
}

/// Returns the page; `next` is the page to go to afterwards, `why_not` the error of the last
/// attempt, `provider` an OpenID provider at which people may sign in as well.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn sign_in(
    shell: Shell,
    next: &str,
    why_not: Option<&str>,
    provider: Option<Offered<'_>>,
) -> Result<String> {
    Ok(SignInPage { shell, next, why_not, provider }.render()?)
}

#[derive(Template)]
#[template(path = "leave.html")]
struct LeavePage<'a> {
    shell: Shell,
    provider: Offered<'a>,
}

/// Returns the page with the link to the provider with which the account will be linked. A form
/// cannot lead there by itself: the policy of the pages restricts forms to this server.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn leave(shell: Shell, provider: Offered<'_>) -> Result<String> {
    Ok(LeavePage { shell: shell.at("/account"), provider }.render()?)
}
