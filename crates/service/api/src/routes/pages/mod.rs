//! Routes of the pages for people, which `sistership_pages` renders.

mod act;
mod answer;
mod draft;
mod look;
mod new_ship;
mod openid;
mod people;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post};

use crate::app::App;
use crate::config::Limits;

/// Size of a form other than an upload, bytes.
const FORM_BYTES: usize = 256 << 10;

pub(super) fn routes(limits: &Limits) -> Router<App> {
    let forms = Router::new()
        .route("/", get(look::fleet))
        .route("/new-ship", get(new_ship::form))
        .route("/ships", post(new_ship::create))
        .route("/ships/{ship}", get(look::ship))
        .route("/ships/{ship}/refine", post(act::refine))
        .route("/ships/{ship}/diagnose", post(act::diagnose))
        .route("/ships/{ship}/champion", post(act::promote))
        .route("/ships/{ship}/note", post(act::note))
        .route("/ships/{ship}/tag", post(act::tag))
        .route("/ships/{ship}/untag", post(act::untag))
        .route("/ships/{ship}/versions/{number}", get(look::version))
        .route("/ships/{ship}/uploads/{draft}", get(draft::shown).post(draft::corrected))
        .route("/trials/{id}", get(look::trial))
        .route("/compare", get(look::compare))
        .route("/playground", get(look::playground))
        .route("/families", get(look::families))
        .route("/families/{family}", get(look::family))
        .route("/zoo", get(look::zoo))
        .route("/zoo/laws/{law}", get(look::law))
        .route("/zoo/effects/{effect}", get(look::effect))
        .route("/jobs", get(look::jobs))
        .route("/jobs/{id}", get(look::job))
        .route("/jobs/{id}/cancel", post(act::cancel))
        .route("/jobs/{id}/retry", post(act::retry))
        .route("/sign-in", get(people::sign_in).post(people::signed_in))
        .route("/sign-in/oidc", get(openid::begin))
        .route("/sign-in/oidc/callback", get(openid::callback))
        .route("/sign-out", post(people::sign_out))
        .route("/account", get(people::account))
        .route("/account/password", post(people::password))
        .route("/account/identity", post(openid::link))
        .route("/users", get(people::users).post(people::create))
        .route("/users/{user}/roles", post(people::set_roles))
        .route("/users/{user}/password", post(people::set_password))
        .route("/users/{user}/disable", post(people::disable))
        .route("/users/{user}/enable", post(people::enable))
        .route("/keys", post(people::make_key))
        .route("/keys/{prefix}/revoke", post(people::revoke))
        .route("/settings", post(people::settings))
        .route("/audit", get(people::audit))
        .layer(DefaultBodyLimit::max(FORM_BYTES));
    // Uploads have a limit of their own.
    let upload = Router::new()
        .route("/ships/{ship}/upload", get(draft::choose).post(draft::arrived))
        .layer(DefaultBodyLimit::max(limits.upload_bytes));
    forms.merge(upload)
}
