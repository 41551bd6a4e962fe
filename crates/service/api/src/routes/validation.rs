//! Validation of versions against the trials of their ships.

use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use sistership_jobs::validation::{Validation, ValidationInputs};
use sistership_report::render_validation;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::{Name, Number, PathParams, QueryParams, accept};

const JSON: &str = "application/json";
const HTML: &str = "text/html";

pub(super) fn validation_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(validation))
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct ValidationQuery {
    /// `json` or `html`; takes precedence over `Accept`.
    #[param(inline)]
    format: Option<ValidationFormat>,
}

#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum ValidationFormat {
    Json,
    Html,
}

/// Validate a version after ITTC 7.5-02-06-03
///
/// Comparison error and validation uncertainty of every quantity of the ship's published trials,
/// and of its turning circles and zigzags that neither the version nor one before it was fitted to.
#[utoipa::path(
    get, path = "/v1/models/{model}/versions/{number}/validation", tag = "models",
    params(("model" = inline(Name), Path), ("number" = inline(Number), Path), ValidationQuery),
    responses((status = 200, content((Validation = "application/json"), (String = "text/html"))))
)]
async fn validation(
    State(app): State<App>,
    PathParams((model, number)): PathParams<(Name, Number)>,
    QueryParams(query): QueryParams<ValidationQuery>,
    headers: HeaderMap,
) -> Result<Response> {
    let media = match query.format {
        Some(ValidationFormat::Json) => JSON,
        Some(ValidationFormat::Html) => HTML,
        None => accept::choose_media(&headers, &[JSON, HTML])?,
    };
    let version = app.store().versions().get(&model, number.get()).await?;
    let asked = ValidationInputs::load(app.archive(), &version).await?;
    // Validation simulates and propagates uncertainty, with the memory of a job.
    let _share = app.job_memory().reserve(asked.memory_demand(), app.limits().memory_wait).await?;
    let samples = app.archive().read_trials(&asked.recipe_trials()).await?;
    let done = app.run_blocking(move || asked.run_validation(&samples)).await?;
    let done = done.map_err(|error| Problem::invalid("number", error.to_string()))?;
    let rendered = render_validation(&done).map_err(Problem::internal)?;
    let body = if media == HTML { rendered.html } else { rendered.json.to_string() };
    let media = if media == HTML { "text/html; charset=utf-8" } else { media };
    let head = [
        (header::CONTENT_TYPE, media),
        (header::VARY, "accept"),
        (header::CONTENT_SECURITY_POLICY, sistership_pages::report_policy()),
    ];
    Ok((head, body).into_response())
}
