//! The sign-in page.

use askama::Template;

use crate::error::Result;
use crate::shell::PageShell;

#[derive(Template)]
#[template(path = "sign_in.html")]
struct SignInPage<'a> {
    shell: PageShell,
    next: &'a str,
    why_not: Option<&'a str>,
    provider: Option<ProviderLink<'a>>,
}

/// A provider at which people may sign in.
#[derive(Debug, Clone, Copy)]
pub struct ProviderLink<'a> {
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
pub fn sign_in_page(
    shell: PageShell,
    next: &str,
    why_not: Option<&str>,
    provider: Option<ProviderLink<'_>>,
) -> Result<String> {
    Ok(SignInPage { shell, next, why_not, provider }.render()?)
}

#[derive(Template)]
#[template(path = "leave.html")]
struct LeavePage<'a> {
    shell: PageShell,
    provider: ProviderLink<'a>,
}

/// Returns the page with the link to the provider with which the account will be linked. A form
/// cannot lead there by itself: the policy of the pages restricts forms to this server.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn leave_page(shell: PageShell, provider: ProviderLink<'_>) -> Result<String> {
    Ok(LeavePage { shell: shell.at_place("/account"), provider }.render()?)
}
