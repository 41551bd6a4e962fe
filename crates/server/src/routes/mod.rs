//! The endpoints, one file a group, and the document that describes them.

mod aliases;
mod bulk_refinements;
mod champion;
mod condition;
mod described;
mod diagnoses;
mod document;
mod drift;
mod effects;
mod events;
mod families;
mod health;
mod jobs;
mod laws;
mod metrics;
mod model_ref;
mod named_trials;
mod pages;
mod predictions;
mod queue;
mod refinements;
mod register;
mod reports;
mod samples;
mod ship_changes;
mod ship_search;
mod ships;
mod similar;
mod tags;
mod tidy;
mod trials;
mod uploads;
mod versions;

use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::StatusCode;
use axum::middleware::from_fn_with_state;
use axum::routing::get;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::timeout::TimeoutLayer;
use utoipa_axum::router::OpenApiRouter;

pub use document::openapi;

use crate::app::App;
use crate::config::Limits;
use crate::web::query::{self, KnownQuery};
use crate::web::{envelope, guard};

/// Everything that is served.
pub(crate) fn router(app: App) -> Router {
    let (api, described) = api(app.limits()).split_for_parts();
    let known = Arc::new(KnownQuery::of(&described));
    let api = api.route_layer(from_fn_with_state(known, query::refuse_unknown));
    let text = document::text();
    api.route("/openapi.json", get(move || async move { document::served(text) }))
        .merge(pages::routes())
        .fallback(envelope::nowhere)
        .layer(from_fn_with_state(app.clone(), guard::guard))
        .layer(CatchPanicLayer::custom(envelope::panicked))
        .layer(from_fn_with_state(app.clone(), envelope::envelope))
        .with_state(app)
}

/// The endpoints that the OpenAPI document describes.
fn api(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::with_openapi(document::about()).merge(quick(limits)).merge(long(limits))
}

/// What is answered at once.
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
        .merge(similar::routes())
        .merge(champion::routes())
        .merge(trials::routes())
        .merge(samples::routes())
        .merge(refinements::routes())
        .merge(diagnoses::routes())
        .merge(jobs::routes())
        .merge(events::routes())
        .merge(versions::routes())
        .merge(register::routes())
        .merge(aliases::routes())
        .merge(predictions::routes())
        .merge(reports::routes())
        .layer(DefaultBodyLimit::max(limits.document_bytes))
        .layer(TimeoutLayer::with_status_code(StatusCode::GATEWAY_TIMEOUT, limits.request_time))
}

/// What takes long: uploads, and deriving a version again.
fn long(limits: &Limits) -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .merge(uploads::routes())
        .merge(versions::verification())
        .layer(DefaultBodyLimit::max(limits.upload_bytes))
        .layer(TimeoutLayer::with_status_code(StatusCode::GATEWAY_TIMEOUT, limits.long_request_time))
}
