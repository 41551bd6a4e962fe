//! The page of an error.

use askama::Template;

use crate::error::Result;
use crate::shell::PageShell;

#[derive(Template)]
#[template(path = "problem.html")]
struct ProblemPage<'a> {
    shell: PageShell,
    title: &'a str,
    detail: &'a str,
    faults: &'a [(String, String)],
    instance: &'a str,
}

/// Returns the page; `faults` are fields with their errors.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn problem_page(
    title: &str,
    detail: &str,
    faults: &[(String, String)],
    instance: &str,
) -> Result<String> {
    Ok(ProblemPage { shell: PageShell::default(), title, detail, faults, instance }.render()?)
}
