//! All endpoints of the OpenAPI document, with the limits that apply to them.

use axum::extract::DefaultBodyLimit;
use axum::http::StatusCode;
use tower_http::timeout::TimeoutLayer;
use utoipa_axum::router::OpenApiRouter;

use super::{
    about, aliases, audit, branches, bulk_refinements, champion, compare, diagnoses, drift,
    effects, events, exports, families, health, jobs, keys, laws, metrics, notes, predictions,
    refinements, register, reports, samples, session_stream, sessions, ship_changes, ships,
    similar, tags, trials, uploads, users, validation, versions, webhooks,
};
use crate::app::App;
use crate::config::Limits;

/// Returns the endpoints of the OpenAPI document.
pub(super) fn api(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::with_openapi(about::about()).merge(quick(limits)).merge(long(limits))
}

/// Returns the endpoints that answer at once.
fn quick(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .merge(health::routes())
        .merge(metrics::routes())
        .merge(families::routes())
        .merge(drift::routes())
        .merge(bulk_refinements::routes())
        .merge(effects::routes())
        .merge(laws::routes())
        .merge(ships::routes())
        .merge(ship_changes::routes())
        .merge(tags::routes())
        .merge(notes::routes())
        .merge(similar::routes())
        .merge(champion::routes())
        .merge(trials::routes())
        .merge(samples::routes())
        .merge(refinements::routes())
        .merge(diagnoses::routes())
        .merge(branches::routes())
        .merge(jobs::routes())
        .merge(events::routes())
        .merge(versions::routes())
        .merge(exports::routes())
        .merge(compare::routes())
        .merge(validation::routes())
        .merge(register::routes())
        .merge(aliases::routes())
        .merge(predictions::routes())
        .merge(sessions::routes())
        .merge(session_stream::routes())
        .merge(reports::routes())
        .merge(users::routes())
        .merge(keys::routes())
        .merge(audit::routes())
        .merge(webhooks::routes())
        .layer(DefaultBodyLimit::max(limits.document_bytes))
        .layer(TimeoutLayer::with_status_code(StatusCode::GATEWAY_TIMEOUT, limits.request_time))
}

/// Returns the endpoints that take long: uploads, and the derivation of a version again.
fn long(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .merge(uploads::routes())
        .merge(versions::verification())
        .layer(DefaultBodyLimit::max(limits.upload_bytes))
        .layer(TimeoutLayer::with_status_code(
            StatusCode::GATEWAY_TIMEOUT,
            limits.long_request_time,
        ))
}
