//! Liveness and readiness of the server.

use std::sync::atomic::Ordering;

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use serde::Serialize;
use sistership_store::StoreError;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use sistership_model::version::code_revision;

pub(super) fn health_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(healthz)).routes(routes!(readyz))
}

/// State of the server.
#[derive(Debug, Serialize, ToSchema)]
struct Health {
    /// Always `ok`: any other state is a problem.
    status: &'static str,
    /// Revision of the program.
    revision: &'static str,
    /// `no space` if nothing can be stored at present: reading goes on, writes get 507. Only
    /// `/readyz` reports it.
    #[serde(skip_serializing_if = "Option::is_none")]
    writes: Option<&'static str>,
}

fn healthy(writes: Option<&'static str>) -> Json<Health> {
    Json(Health { status: "ok", revision: code_revision(), writes })
}

/// Check that the server is running
#[utoipa::path(get, path = "/healthz", tag = "health", responses((status = 200, body = Health)))]
async fn healthz() -> Json<Health> {
    healthy(None)
}

/// Check that the server can work: its database and its object store answer, and it is not stopping
#[utoipa::path(get, path = "/readyz", tag = "health", responses((status = 200, body = Health)))]
async fn readyz(State(app): State<App>) -> Result<Json<Health>> {
    if app.stop_signal().is_stopping() {
        return Err(Problem::new(StatusCode::SERVICE_UNAVAILABLE, "the server is stopping"));
    }
    app.store().check_health().await.map_err(|error| not_ready("database", &error))?;
    app.objects().check_health().await.map_err(|error| not_ready("object store", &error))?;
    let no_room = app.is_out_of_space().load(Ordering::Relaxed);
    Ok(healthy(Some(if no_room { "no space" } else { "ok" })))
}

fn not_ready(what: &str, error: &StoreError) -> Problem {
    tracing::warn!(%error, "the {what} does not answer");
    Problem::new(
        StatusCode::SERVICE_UNAVAILABLE,
        format!("the {what} does not answer; see the server's log"),
    )
}
