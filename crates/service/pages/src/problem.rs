//! A page that says why something was not done.

use askama::Template;

use crate::error::Result;
use crate::shell::Shell;

#[derive(Template)]
#[template(path = "problem.html")]
struct ProblemPage<'a> {
    shell: Shell,
    title: &'a str,
    detail: &'a str,
    faults: &'a [(String, String)],
    instance: &'a str,
}

/// The page; `faults` are places with what is wrong there.
///
/// # Errors
/// The page cannot be written.
pub fn problem(
    title: &str,
    detail: &str,
    faults: &[(String, String)],
    instance: &str,
) -> Result<String> {
    Ok(ProblemPage { shell: Shell::default(), title, detail, faults, instance }.render()?)
}
