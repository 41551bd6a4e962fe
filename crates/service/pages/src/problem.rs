//! The page of an error.

use askama::Template;

use crate::error::Result;
use crate::language::{has_word, say_word};
use crate::shell::PageShell;

#[derive(Template)]
#[template(path = "problem.html")]
struct ProblemPage<'a> {
    shell: PageShell,
    title: String,
    detail: &'a str,
    faults: &'a [(String, String)],
    instance: &'a str,
}

/// An error as an answer of the REST interface has it.
#[derive(Debug, Clone, Copy)]
pub struct PageProblem<'a> {
    /// URI of its kind, whose last part names the translation of the title.
    pub kind: &'a str,
    /// Title in English, for kinds without a translation.
    pub title: &'a str,
    /// Description.
    pub detail: &'a str,
    /// Fields with their errors.
    pub faults: &'a [(String, String)],
    /// Id of the occurrence.
    pub instance: &'a str,
}

/// Returns the page.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn problem_page(of: PageProblem<'_>) -> Result<String> {
    let PageProblem { kind, title, detail, faults, instance } = of;
    let name = kind.rsplit(':').next().unwrap_or_default();
    let title = match has_word("problem", name) {
        true => say_word("problem", name),
        false => title.to_owned(),
    };
    Ok(ProblemPage { shell: PageShell::default(), title, detail, faults, instance }.render()?)
}
