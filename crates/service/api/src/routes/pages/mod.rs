//! Routes of the pages for people, which `sistership_pages` renders.

mod answer;
mod draft;
mod example;
mod form_actions;
mod language;
mod new_ship;
mod openid;
mod people;
mod statements;
mod views;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post};

use crate::app::App;
use crate::config::Limits;

/// Size of a form other than an upload, bytes.
const FORM_BYTES: usize = 256 << 10;

pub(super) fn page_routes(limits: &Limits) -> Router<App> {
    let forms = Router::new()
        .route("/", get(views::fleet_page))
        .route("/new-ship", get(new_ship::new_ship_form))
        .route("/ships", post(new_ship::create_ship))
        .route("/example", post(example::load_example))
        .route("/ships/{ship}", get(views::ship_page))
        .route("/ships/{ship}/turn.svg", get(views::champion_turn))
        .route("/ships/{ship}/versions/{number}/turn.svg", get(views::version_turn))
        .route("/ships/{ship}/refine", post(form_actions::refine_ship))
        .route("/ships/{ship}/diagnose", post(form_actions::diagnose_ship))
        .route("/ships/{ship}/champion", post(form_actions::promote_version))
        .route("/ships/{ship}/note", post(form_actions::add_note))
        .route("/ships/{ship}/tag", post(form_actions::add_tag))
        .route("/ships/{ship}/untag", post(form_actions::remove_tag))
        .route(
            "/ships/{ship}/particulars",
            get(statements::particulars_form).post(statements::change_particulars),
        )
        .route(
            "/ships/{ship}/conditions",
            get(statements::conditions_form).post(statements::state_conditions),
        )
        .route("/ships/{ship}/versions/{number}", get(views::version_page))
        .route("/ships/{ship}/versions/{number}/acceptance", get(statements::summary_page))
        .route("/ships/{ship}/versions/{number}/sign", post(statements::sign_version))
        .route(
            "/ships/{ship}/uploads/{draft}",
            get(draft::review_draft).post(draft::apply_corrections),
        )
        .route("/ships/{ship}/uploaded", get(draft::stored_upload))
        .route("/trials/{id}", get(views::trial_page))
        .route("/compare", get(views::compare_page))
        .route("/playground", get(views::playground_page))
        .route("/families", get(views::families_page).post(form_actions::create_family))
        .route("/families/{family}", get(views::family_page))
        .route("/families/{family}/members", post(form_actions::add_members))
        .route("/zoo", get(views::zoo_page))
        .route("/zoo/laws/{law}", get(views::law_page))
        .route("/zoo/effects/{effect}", get(views::effect_page))
        .route("/jobs", get(views::jobs_page))
        .route("/jobs/{id}", get(views::job_page))
        .route("/jobs/{id}/cancel", post(form_actions::cancel_job))
        .route("/jobs/{id}/retry", post(form_actions::retry_job))
        .route("/sign-in", get(people::sign_in_form).post(people::sign_in_user))
        .route("/sign-in/oidc", get(openid::begin_sign_in))
        .route("/sign-in/oidc/callback", get(openid::finish_sign_in))
        .route("/sign-out", post(people::sign_out))
        .route("/account", get(people::account_page))
        .route("/account/password", post(people::change_password))
        .route("/account/identity", post(openid::link_account))
        .route("/users", get(people::users_page).post(people::create_user))
        .route("/users/{user}/roles", post(people::set_roles))
        .route("/users/{user}/password", post(people::set_password))
        .route("/users/{user}/disable", post(people::disable_user))
        .route("/users/{user}/enable", post(people::enable_user))
        .route("/keys", post(people::make_key))
        .route("/keys/{prefix}/revoke", post(people::revoke_key))
        .route("/settings", post(people::change_settings))
        .route("/webhooks", get(people::webhooks_page).post(people::make_webhook))
        .route("/webhooks/address", post(people::set_address))
        .route("/webhooks/{id}/end", post(people::end_webhook))
        .route("/audit", get(people::audit_page))
        .route("/language", post(language::choose_language))
        .layer(DefaultBodyLimit::max(FORM_BYTES));
    // Uploads have a limit of their own.
    let upload = Router::new()
        .route("/ships/{ship}/upload", get(draft::choose_files).post(draft::receive_files))
        .layer(DefaultBodyLimit::max(limits.upload_bytes));
    forms.merge(upload)
}
