//! Metrics for Prometheus.

use axum::extract::State;
use axum::http::header;
use axum::response::IntoResponse;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::metrics::MEDIA;
use crate::problem::Result;

pub(super) fn metrics_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(metrics))
}

/// Get requests by route and status, their duration, jobs by kind and state, the queue's age, and
/// the object store's size
#[utoipa::path(
    get, path = "/metrics", tag = "health",
    responses((status = 200, body = String, content_type = "application/openmetrics-text"))
)]
async fn metrics(State(app): State<App>) -> Result<impl IntoResponse> {
    Ok(([(header::CONTENT_TYPE, MEDIA)], app.metrics().scrape(app.archive()).await?))
}
