//! The language of a request: the choice of a person, kept in a cookie, or that of the browser.

use axum::http::{HeaderMap, header};
use sistership_pages::Language;

use crate::accounts::find_cookie;

/// Cookie with the code of the chosen language.
pub(crate) const LANGUAGE_COOKIE: &str = "sistership_language";
/// Headers on which a page depends.
pub(crate) const VARY: &str = "Accept-Language, Cookie";

/// Returns the language in which a request is answered.
pub(crate) fn request_language(headers: &HeaderMap) -> Language {
    let accepted = headers.get(header::ACCEPT_LANGUAGE).and_then(|value| value.to_str().ok());
    Language::from_request(find_cookie(headers, LANGUAGE_COOKIE), accepted)
}
