//! Where a page of a list ends, in a form that an address can hold.

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{PageError, Result};

/// The key as text.
pub(crate) fn cursor<K: Serialize>(key: Option<&K>) -> Option<String> {
    Some(BASE64_URL_SAFE_NO_PAD.encode(serde_json::to_vec(key?).ok()?))
}

/// The key that a text stands for.
pub(crate) fn key<K: DeserializeOwned>(after: Option<&str>) -> Result<Option<K>> {
    let read = |text: &str| {
        let bytes = BASE64_URL_SAFE_NO_PAD.decode(text).ok();
        bytes
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .ok_or_else(|| PageError::invalid("after", "is no place of this list; begin anew"))
    };
    after.map(read).transpose()
}
