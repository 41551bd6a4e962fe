//! Export of versions for other tools.

use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use sistership_jobs::version_export::ExportFormat;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::binary::Binary;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::{Name, Number, PathParams, QueryParams};

pub(super) fn export_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(export))
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct ExportQuery {
    #[param(inline)]
    format: Option<ExportFormat>,
}

/// Export a version as a file for another tool
///
/// The file has the law with the model's effects, the steering gear, and a current as an input, as
/// in a prediction. A learned correction is written with it.
#[utoipa::path(
    get, path = "/v1/models/{model}/versions/{number}/export", tag = "models",
    params(("model" = inline(Name), Path), ("number" = inline(Number), Path), ExportQuery),
    responses((status = 200, description = "The file",
    content((Binary = "application/octet-stream")), headers(("Content-Disposition" = String))))
)]
async fn export(
    State(app): State<App>,
    PathParams((name, number)): PathParams<(Name, Number)>,
    QueryParams(query): QueryParams<ExportQuery>,
) -> Result<Response> {
    let version = app.store().versions().get(&name, number.get()).await?;
    let law = app.stored_law(&version.head.law).await?;
    let format = query.format.unwrap_or_default();
    let model = app.archive().model_with_weights(&version).await?;
    let exported =
        app.run_blocking(move || format.export_version(&version, (&model, &law))).await?;
    let exported = exported.map_err(|error| Problem::invalid("format", error.to_string()))?;
    let kept = format!("attachment; filename=\"{}\"", exported.file);
    let media = [(header::CONTENT_TYPE, "application/octet-stream")];
    Ok((media, [(header::CONTENT_DISPOSITION, kept)], exported.bytes).into_response())
}
