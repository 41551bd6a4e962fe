//! What is refused before any database sees it.

use serde::de::IgnoredAny;

use crate::error::{Result, StoreError};

/// The longest text that a field may hold.
pub const MAX_TEXT_BYTES: usize = 16 << 20;
/// The longest name of a ship, law, model, alias or kind.
pub const MAX_NAME_CHARS: usize = 200;
/// The longest text of one line: a subject of OpenID Connect (Core 1.0, 2), an address.
const MAX_LINE_CHARS: usize = 255;

/// A name that can stand in a URL path: not empty, not long, no white space, control character or
/// slash.
pub(crate) fn name(field: &'static str, value: &str) -> Result<()> {
    if value.is_empty() {
        return Err(StoreError::invalid(field, "must not be empty"));
    }
    if value.chars().count() > MAX_NAME_CHARS {
        return Err(StoreError::invalid(field, format!("longer than {MAX_NAME_CHARS} characters")));
    }
    match value.chars().find(|c| c.is_control() || c.is_whitespace() || *c == '/') {
        Some(c) => Err(StoreError::invalid(field, format!("must not contain {c:?}"))),
        None => Ok(()),
    }
}

/// A text that is one JSON document.
pub(crate) fn json(field: &'static str, value: &str) -> Result<()> {
    text(field, value)?;
    serde_json::from_str::<IgnoredAny>(value)
        .map(drop)
        .map_err(|error| StoreError::invalid(field, format!("not a JSON document: {error}")))
}

/// A SHA-256 in lower-case hexadecimal.
pub(crate) fn sha256(field: &'static str, value: &str) -> Result<()> {
    let hexadecimal = |byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    match value.len() == 64 && value.bytes().all(hexadecimal) {
        true => Ok(()),
        false => Err(StoreError::invalid(field, "not a SHA-256 in lower-case hexadecimal")),
    }
}

/// A text without NUL (PostgreSQL has none) and not too long.
pub(crate) fn text(field: &'static str, value: &str) -> Result<()> {
    if value.len() > MAX_TEXT_BYTES {
        return Err(StoreError::invalid(field, format!("longer than {MAX_TEXT_BYTES} bytes")));
    }
    match value.contains('\0') {
        true => Err(StoreError::invalid(field, "must not contain a NUL character")),
        false => Ok(()),
    }
}

/// A text of one line that says something and is not long.
pub(crate) fn line(field: &'static str, value: &str) -> Result<()> {
    if value.is_empty() || value.chars().count() > MAX_LINE_CHARS {
        let message = format!("must have 1 to {MAX_LINE_CHARS} characters");
        return Err(StoreError::invalid(field, message));
    }
    match value.chars().find(|c| c.is_control()) {
        Some(c) => Err(StoreError::invalid(field, format!("must not contain {c:?}"))),
        None => Ok(()),
    }
}

/// A number that is one.
pub(crate) fn finite(field: &'static str, value: f64) -> Result<()> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(StoreError::invalid(field, format!("must be a finite number, not {value}"))),
    }
}

/// A number that is zero or more.
pub(crate) fn not_negative(field: &'static str, value: f64) -> Result<()> {
    finite(field, value)?;
    match value >= 0.0 {
        true => Ok(()),
        false => Err(StoreError::invalid(field, format!("must not be negative, is {value}"))),
    }
}

/// A count.
pub(crate) fn count(field: &'static str, value: i64) -> Result<()> {
    match value >= 0 {
        true => Ok(()),
        false => Err(StoreError::invalid(field, format!("must not be negative, is {value}"))),
    }
}
