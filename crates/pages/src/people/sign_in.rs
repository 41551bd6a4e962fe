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
}

/// The page; `next` is where to go then, `why_not` what was wrong with the last attempt.
///
/// # Errors
/// The page cannot be written.
pub fn sign_in(shell: Shell, next: &str, why_not: Option<&str>) -> Result<String> {
    Ok(SignInPage { shell, next, why_not }.render()?)
}
