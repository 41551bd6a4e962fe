//! The choice of a language.

use axum::extract::State;
use axum::http::{HeaderMap, Uri, header};
use axum::response::Response;
use sistership_pages::{Language, say};

use super::answer::{local_path, redirect_to, with_cookie};
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::form::PageForm;
use crate::web::language::LANGUAGE_COOKIE;

/// Time for which a choice is kept, seconds: a year.
const CHOICE_AGE_S: u32 = 365 * 86_400;

/// Keeps the language of the form, and leads back to the page from which it was chosen.
pub(super) async fn choose_language(
    State(_): State<App>,
    headers: HeaderMap,
    PageForm(form): PageForm,
) -> Result<Response> {
    let code = form.required_text("language")?;
    let chosen = Language::by_code(code)
        .ok_or_else(|| Problem::invalid("language", say("language-unknown").with("code", code)))?;
    let cookie = format!("{LANGUAGE_COOKIE}={}; Max-Age={CHOICE_AGE_S}; Path=/", chosen.code());
    let place = page_before(&headers);
    Ok(with_cookie(redirect_to(local_path(place.as_deref())), &cookie))
}

/// Path of the page that sent the form: browsers state it to its own server.
fn page_before(headers: &HeaderMap) -> Option<String> {
    let place = headers.get(header::REFERER)?.to_str().ok()?.parse::<Uri>().ok()?;
    place.path_and_query().map(ToString::to_string)
}
