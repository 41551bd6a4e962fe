//! Checks of values before they are sent to a database.

use serde::de::IgnoredAny;

use crate::error::{Result, StoreError};

/// Maximum length of a text field, bytes.
pub const MAX_TEXT_BYTES: usize = 16 << 20;
/// Maximum length of the name of a ship, law, model, alias or kind, characters.
pub const MAX_NAME_CHARS: usize = 200;
/// Maximum length of a text of one line, characters: a subject of OpenID Connect (Core 1.0, 2), an
/// address.
const MAX_LINE_CHARS: usize = 255;

/// Checks a name that is part of a URL path: not empty, not too long, no white space, control
/// character or slash.
pub(crate) fn check_name(field: &'static str, value: &str) -> Result<()> {
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

/// Checks that a text is one JSON document.
pub(crate) fn check_json(field: &'static str, value: &str) -> Result<()> {
    check_text(field, value)?;
    // Checks the syntax without building the document in memory.
    serde_json::from_str::<IgnoredAny>(value)
        .map(drop)
        .map_err(|error| StoreError::invalid(field, format!("not a JSON document: {error}")))
}

/// Checks that a text is a SHA-256 in lower-case hexadecimal.
pub(crate) fn check_sha256(field: &'static str, value: &str) -> Result<()> {
    let hexadecimal = |byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    match value.len() == 64 && value.bytes().all(hexadecimal) {
        true => Ok(()),
        false => Err(StoreError::invalid(field, "not a SHA-256 in lower-case hexadecimal")),
    }
}

/// Checks a text: no NUL (PostgreSQL cannot store it), and not too long.
pub(crate) fn check_text(field: &'static str, value: &str) -> Result<()> {
    if value.len() > MAX_TEXT_BYTES {
        return Err(StoreError::invalid(field, format!("longer than {MAX_TEXT_BYTES} bytes")));
    }
    match value.contains('\0') {
        true => Err(StoreError::invalid(field, "must not contain a NUL character")),
        false => Ok(()),
    }
}

/// Checks a text of one line: not empty, not too long, no control character.
pub(crate) fn check_line(field: &'static str, value: &str) -> Result<()> {
    if value.is_empty() || value.chars().count() > MAX_LINE_CHARS {
        let message = format!("must have 1 to {MAX_LINE_CHARS} characters");
        return Err(StoreError::invalid(field, message));
    }
    match value.chars().find(|c| c.is_control()) {
        Some(c) => Err(StoreError::invalid(field, format!("must not contain {c:?}"))),
        None => Ok(()),
    }
}

/// Checks that a number is finite.
pub(crate) fn check_finite(field: &'static str, value: f64) -> Result<()> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(StoreError::invalid(field, format!("must be a finite number, not {value}"))),
    }
}

/// Checks that a number is finite and not negative.
pub(crate) fn check_not_negative(field: &'static str, value: f64) -> Result<()> {
    check_finite(field, value)?;
    match value >= 0.0 {
        true => Ok(()),
        false => Err(StoreError::invalid(field, format!("must not be negative, is {value}"))),
    }
}

/// Checks that a count is not negative.
pub(crate) fn check_count(field: &'static str, value: i64) -> Result<()> {
    match value >= 0 {
        true => Ok(()),
        false => Err(StoreError::invalid(field, format!("must not be negative, is {value}"))),
    }
}
