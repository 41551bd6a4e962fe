//! The only entrance of YAML: a text for which the parser would take unbounded time or memory is
//! refused before it is parsed.
//!
//! The parser (libyaml) searches every open `[` and `{` at each token, so that the time grows with
//! the square of the nesting depth, and it checks its limit of depth only afterwards; it searches
//! every `%TAG` at each tag; and it reads an alias as often as the alias occurs, so that a megabyte
//! with a thousand aliases becomes a gigabyte.

mod aliases;
mod brackets;
mod line_break;
mod structure;

pub use brackets::MAX_DEPTH;
pub(crate) use structure::find_faults;

use serde::de::DeserializeOwned;

/// Largest size of a document, bytes.
pub const MAX_BYTES: usize = 8 << 20;

/// Largest number of commas, brackets, colons, dashes and question marks that may each begin an
/// item of a document.
pub const MAX_ITEMS: usize = 400_000;

/// Largest number of faults that are reported of one document: each is searched in the text, and a
/// text may have hundreds of thousands.
pub const MAX_FAULTS: usize = 20;

/// Error of a YAML text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct YamlError {
    /// Line, counted from 1, if known.
    pub line: Option<usize>,
    /// Description and, for limits, the found and the permitted value.
    pub message: String,
}

/// Reads a document.
///
/// # Errors
/// Returns an error with the parser's own line and column, or the limit that the text exceeds.
pub fn read_document<T: DeserializeOwned>(text: &str) -> Result<T, YamlError> {
    check_limits(text)?;
    let refused = |error: serde_yaml::Error| YamlError {
        line: error.location().map(|place| place.line()),
        message: error.to_string(),
    };
    // Read as a value first, because a map would silently keep the second value of a duplicate key.
    serde_yaml::from_str::<serde_yaml::Value>(text).map_err(refused)?;
    serde_yaml::from_str(text).map_err(refused)
}

/// Refuses a text that the parser should not read.
fn check_limits(text: &str) -> Result<(), YamlError> {
    if text.len() > MAX_BYTES {
        let message = format!("a YAML document of {} bytes; the limit is {MAX_BYTES}", text.len());
        return Err(YamlError { line: None, message });
    }
    // The size of the parsed document is bounded by the number of its items.
    let items = count_items(text.as_bytes());
    if items > MAX_ITEMS {
        let message = format!("a YAML document of about {items} items; the limit is {MAX_ITEMS}");
        return Err(YamlError { line: None, message });
    }
    let at = |(place, message): (usize, String)| {
        let line = 1 + text.as_bytes()[..place].iter().filter(|byte| **byte == b'\n').count();
        YamlError { line: Some(line), message: format!("{message} at line {line}") }
    };
    aliases::check_aliases(text.as_bytes()).map_err(at)?;
    brackets::check_brackets(text.as_bytes()).map_err(at)
}

/// Returns an upper bound of the number of items.
fn count_items(bytes: &[u8]) -> usize {
    let is_mark = |at: usize| match bytes[at] {
        b',' | b'[' | b'{' | b'?' => true,
        b':' | b'-' => bytes.get(at + 1).is_none_or(|next| !next.is_ascii_graphic()),
        _ => false,
    };
    (0..bytes.len()).filter(|&at| is_mark(at)).count()
}

#[cfg(test)]
mod tests;
