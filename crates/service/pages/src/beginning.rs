//! The part of a page before its content, which is known before the content is computed.

use askama::Template;

use crate::error::Result;
use crate::shell::PageShell;

/// First characters of the content of every page.
const CONTENT_START: &str = "<main id=\"content\" tabindex=\"-1\">";

#[derive(Template)]
#[template(path = "blank.html")]
struct BlankPage<'a> {
    shell: PageShell,
    title: &'a str,
}

/// Returns a page up to its content; `place` is its place in the navigation.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn page_beginning(shell: PageShell, title: &str, place: &'static str) -> Result<String> {
    let mut page = BlankPage { shell: shell.at_place(place), title }.render()?;
    page.truncate(content_offset(&page));
    Ok(page)
}

/// Returns a page from its content on.
pub fn from_content(page: &str) -> &str {
    &page[content_offset(page)..]
}

/// Length of the part before the content, bytes.
fn content_offset(page: &str) -> usize {
    page.find(CONTENT_START).map_or(0, |at| at + CONTENT_START.len())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn both_parts_are_a_page() {
        let begins = page_beginning(PageShell::default(), "Not found", "").unwrap();
        let page = crate::problem_page(crate::PageProblem {
            kind: "",
            title: "Not found",
            detail: "nothing of that name",
            faults: &[],
            instance: "",
        })
        .unwrap();
        assert!(page.starts_with(&begins), "{begins}");
        assert_eq!(format!("{begins}{}", from_content(&page)), page);
    }
}
