//! All endpoints of the OpenAPI document, with the limits that apply to them.

use axum::extract::DefaultBodyLimit;
use axum::http::StatusCode;
use tower_http::timeout::TimeoutLayer;
use utoipa_axum::router::OpenApiRouter;

use super::{
    about, aliases, audit, branches, bulk_refinements, champion, compare, diagnoses, drift,
    effects, events, exports, families, health, jobs, keys, laws, metrics, notes, predictions,
    refinements, register, reports, samples, session_stream, sessions, ship_changes, ships,
    signatures, similar, tags, trial_conditions, trials, uploads, users, validation, versions,
    webhooks,
};
use crate::app::App;
use crate::config::Limits;

/// Returns the endpoints of the OpenAPI document.
pub(super) fn api_router(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::with_openapi(about::general_document())
        .merge(quick_router(limits))
        .merge(long_router(limits))
}

/// Returns the endpoints that answer at once.
fn quick_router(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .merge(health::health_routes())
        .merge(metrics::metrics_routes())
        .merge(families::family_routes())
        .merge(drift::drift_routes())
        .merge(bulk_refinements::bulk_routes())
        .merge(effects::effect_routes())
        .merge(laws::law_routes())
        .merge(ships::ship_routes())
        .merge(ship_changes::ship_change_routes())
        .merge(tags::tag_routes())
        .merge(notes::note_routes())
        .merge(similar::similarity_routes())
        .merge(champion::champion_routes())
        .merge(trials::trial_routes())
        .merge(trial_conditions::condition_routes())
        .merge(samples::sample_routes())
        .merge(refinements::refinement_routes())
        .merge(diagnoses::diagnosis_routes())
        .merge(branches::branch_routes())
        .merge(jobs::job_routes())
        .merge(events::event_routes())
        .merge(versions::version_routes())
        .merge(signatures::signature_routes())
        .merge(exports::export_routes())
        .merge(compare::comparison_routes())
        .merge(validation::validation_routes())
        .merge(register::register_routes())
        .merge(aliases::alias_routes())
        .merge(predictions::prediction_routes())
        .merge(sessions::session_routes())
        .merge(session_stream::stream_routes())
        .merge(reports::report_routes())
        .merge(users::user_routes())
        .merge(keys::key_routes())
        .merge(audit::audit_routes())
        .merge(webhooks::webhook_routes())
        .layer(DefaultBodyLimit::max(limits.document_bytes))
        .layer(TimeoutLayer::with_status_code(StatusCode::GATEWAY_TIMEOUT, limits.request_time))
}

/// Returns the endpoints that take long: uploads, and the derivation of a version again.
fn long_router(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .merge(uploads::upload_routes())
        .merge(versions::verification_route())
        .layer(DefaultBodyLimit::max(limits.upload_bytes))
        .layer(TimeoutLayer::with_status_code(
            StatusCode::GATEWAY_TIMEOUT,
            limits.long_request_time,
        ))
}
