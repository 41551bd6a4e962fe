//! The one door for YAML: what the parser would take unbounded time or memory for is refused before
//! it sees it.
//!
//! The parser (libyaml) looks through every open `[` and `{` at each token, so that time grows with
//! the square of how deep they nest, and its limit of depth is only checked after that; it looks
//! through every `%TAG` at each tag; and an alias is read as often as it stands there, so that a
//! megabyte named a thousand times is a gigabyte.

mod aliases;
mod brackets;
mod line_break;
mod structure;

pub use brackets::MAX_DEPTH;
pub(crate) use structure::faults;

use serde::de::DeserializeOwned;

/// Bytes of one document.
pub const MAX_BYTES: usize = 8 << 20;

/// Commas, brackets, colons, dashes and question marks that may each begin an item of a document,
/// whichever of them do.
pub const MAX_ITEMS: usize = 400_000;

/// Faults of one document that are told: each is looked for in the text, and a text may have
/// hundreds of thousands.
pub const MOST_FAULTS: usize = 20;

/// What is wrong with a text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct YamlError {
    /// Line, counted from 1, where it could be told.
    pub line: Option<usize>,
    /// What is wrong and, for limits, what was found and what is allowed.
    pub message: String,
}

/// Reads a document.
///
/// # Errors
/// Says what is wrong, with the parser's own line and column, or which bound the text exceeds.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, YamlError> {
    check(text)?;
    let refused = |error: serde_yaml::Error| YamlError {
        line: error.location().map(|place| place.line()),
        message: error.to_string(),
    };
    // As a value first: of a key that is given twice, a map would silently keep the second.
    serde_yaml::from_str::<serde_yaml::Value>(text).map_err(refused)?;
    serde_yaml::from_str(text).map_err(refused)
}

/// Refuses what the parser should not see.
fn check(text: &str) -> Result<(), YamlError> {
    if text.len() > MAX_BYTES {
        let message = format!("a YAML document of {} bytes; {MAX_BYTES} are the most", text.len());
        return Err(YamlError { line: None, message });
    }
    let items = items(text.as_bytes());
    if items > MAX_ITEMS {
        let message = format!("a YAML document of some {items} items; {MAX_ITEMS} are the most");
        return Err(YamlError { line: None, message });
    }
    let at = |(place, message): (usize, String)| {
        let line = 1 + text.as_bytes()[..place].iter().filter(|byte| **byte == b'\n').count();
        YamlError { line: Some(line), message: format!("{message} at line {line}") }
    };
    aliases::check(text.as_bytes()).map_err(at)?;
    brackets::check(text.as_bytes()).map_err(at)
}

/// How many items there may be.
fn items(bytes: &[u8]) -> usize {
    let is_mark = |at: usize| match bytes[at] {
        b',' | b'[' | b'{' | b'?' => true,
        b':' | b'-' => bytes.get(at + 1).is_none_or(|next| !next.is_ascii_graphic()),
        _ => false,
    };
    (0..bytes.len()).filter(|&at| is_mark(at)).count()
}

#[cfg(test)]
mod tests;
