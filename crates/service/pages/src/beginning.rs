//! The part of a page before its content, which is known before the content is computed.

use askama::Template;

use crate::error::Result;
use crate::shell::Shell;

/// First characters of the content of every page.
const CONTENT: &str = "<main id=\"content\" tabindex=\"-1\">";

#[derive(Template)]
#[template(path = "blank.html")]
struct BlankPage<'a> {
    shell: Shell,
    title: &'a str,
}

/// Returns a page up to its content; `place` is its place in the navigation.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn beginning(shell: Shell, title: &str, place: &'static str) -> Result<String> {
    let mut page = BlankPage { shell: shell.at(place), title }.render()?;
    page.truncate(before_content(&page));
    Ok(page)
}

/// Returns a page from its content on.
pub fn from_content(page: &str) -> &str {
    &page[before_content(page)..]
}

/// Length of the part before the content, bytes.
fn before_content(page: &str) -> usize {
    page.find(CONTENT).map_or(0, |at| at + CONTENT.len())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn both_parts_are_a_page() {
        let begins = beginning(Shell::default(), "Not found", "").unwrap();
        let page = crate::problem("Not found", "nothing of that name", &[], "").unwrap();
        assert!(page.starts_with(&begins), "{begins}");
        assert_eq!(format!("{begins}{}", from_content(&page)), page);
    }
}
