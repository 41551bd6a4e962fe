//! Reports, as data and as pages.

use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::Result;
use crate::web::{Id, PathParams, QueryParams, accept};

const JSON: &str = "application/json";
const HTML: &str = "text/html";

pub(super) fn report_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(get))
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct ReportQuery {
    /// `json` or `html`; takes precedence over `Accept`.
    #[param(inline)]
    format: Option<Format>,
}

#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum Format {
    Json,
    Html,
}

/// Get a report, as JSON or as a self-contained page
#[utoipa::path(
    get, path = "/v1/reports/{id}", tag = "reports", params(("id" = inline(Id), Path), ReportQuery),
    responses((status = 200, content((Object = "application/json"), (String = "text/html"))))
)]
async fn get(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    QueryParams(query): QueryParams<ReportQuery>,
    headers: HeaderMap,
) -> Result<Response> {
    let media = match query.format {
        Some(Format::Json) => JSON,
        Some(Format::Html) => HTML,
        None => accept::choose_media(&headers, &[JSON, HTML])?,
    };
    let report = app.store().reports().get(&id).await?;
    let body = if media == HTML { report.html } else { report.document };
    let media = if media == HTML { "text/html; charset=utf-8" } else { media };
    let head = [
        (header::CONTENT_TYPE, media),
        (header::VARY, "accept"),
        (header::CONTENT_SECURITY_POLICY, sistership_pages::report_policy()),
    ];
    Ok((head, body).into_response())
}
