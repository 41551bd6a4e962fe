//! Cursors of lists, in a form that a URL can hold.

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{PageError, Result};
use crate::language::say;

/// Returns a key as text: JSON in URL-safe Base64.
pub(crate) fn encode_cursor<K: Serialize>(key: Option<&K>) -> Option<String> {
    Some(BASE64_URL_SAFE_NO_PAD.encode(serde_json::to_vec(key?).ok()?))
}

/// Returns the key of a text.
///
/// # Errors
/// Returns an error if the text is no cursor of this list.
pub(crate) fn decode_cursor<K: DeserializeOwned>(after: Option<&str>) -> Result<Option<K>> {
    let read = |text: &str| {
        let bytes = BASE64_URL_SAFE_NO_PAD.decode(text).ok();
        bytes
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .ok_or_else(|| PageError::invalid_field("after", say("form-cursor")))
    };
    after.map(read).transpose()
}
