//! The page to sign in at.

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

/// Somewhere else to sign in.
#[derive(Debug, Clone, Copy)]
pub struct Offered<'a> {
    /// What people call it.
    pub title: &'a str,
    /// What leads there.
    pub place: &'a str,
}

/// The page; `next` is where to go then, `why_not` what was wrong with the last attempt, `provider`
/// who vouches for people, too.
///
/// # Errors
/// The page cannot be written.
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

/// The page from which a person goes to the provider that their account is to be linked with. A
/// form cannot lead there by itself: the policy of pages sends forms to this server only.
///
/// # Errors
/// The page cannot be written.
pub fn leave(shell: Shell, provider: Offered<'_>) -> Result<String> {
    Ok(LeavePage { shell: shell.at("/account"), provider }.render()?)
}
