//! Queries and deletion of trials.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_store::{Trial, visit_pages};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::{Cursor, Limit};
use crate::web::{Id, Listing, Name, PathParams, QueryParams, page};

pub(super) fn trial_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(get, delete))
        .routes(routes!(undelete))
}

/// A trial; its samples are under `/samples`.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct TrialView {
    pub id: String,
    pub ship: String,
    /// Name of the file.
    pub name: String,
    /// SHA-256 of its samples as they are stored.
    pub sha256: String,
    /// Number of samples.
    pub rows: i64,
    pub duration_s: f64,
    /// Manoeuvre, if it is known.
    pub manoeuvre: Option<String>,
    /// Warnings of the checks: `row`, `column`, `message`.
    #[schema(value_type = Vec<Object>)]
    pub warnings: Value,
    /// Entry of the file in the manifest: columns, conventions, depth.
    #[schema(value_type = Object)]
    pub manifest: Value,
    pub created_us: i64,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct TrialQuery {
    /// The ship.
    #[param(inline)]
    ship: Name,
    /// The most items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
}

impl TrialView {
    pub(super) fn from_trial(trial: Trial) -> Self {
        let read = |text: &str| serde_json::from_str(text).unwrap_or_default();
        let (warnings, manifest) = (read(&trial.warnings), read(&trial.manifest));
        let Trial {
            id,
            ship,
            name,
            sha256,
            sample_rows: rows,
            duration_s,
            manoeuvre,
            created_us,
            ..
        } = trial;
        Self { id, ship, name, sha256, rows, duration_s, manoeuvre, warnings, manifest, created_us }
    }
}

/// List the trials of a ship, in the order of their upload
#[utoipa::path(get, path = "/v1/trials", tag = "trials", params(TrialQuery),
    responses((status = 200, body = Listing<TrialView>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<TrialQuery>,
) -> Result<Json<Listing<TrialView>>> {
    app.store().ships().get(&query.ship).await?;
    let trials = app
        .store()
        .trials()
        .list(&query.ship, &page::parse_page(query.limit, query.after.as_ref())?)
        .await?;
    Ok(Json(Listing::from_list(trials, TrialView::from_trial)))
}

/// Get a trial
#[utoipa::path(
    get, path = "/v1/trials/{id}", tag = "trials", params(("id" = inline(Id), Path)),
    responses((status = 200, body = TrialView))
)]
async fn get(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Json<TrialView>> {
    Ok(Json(TrialView::from_trial(app.store().trials().get(&id).await?)))
}

/// Delete a trial; versions that were made with it stay, and `undelete` restores it
#[utoipa::path(
    delete, path = "/v1/trials/{id}", tag = "trials", params(("id" = inline(Id), Path)),
    responses((status = 204, description = "Deleted"))
)]
async fn delete(State(app): State<App>, PathParams(id): PathParams<Id>) -> Result<Response> {
    app.store().trials().delete(&id).await?;
    Ok(StatusCode::NO_CONTENT.into_response())
}

/// Restore a deleted trial
#[utoipa::path(
    post, path = "/v1/trials/{id}/undelete", tag = "trials", params(("id" = inline(Id), Path)),
    responses((status = 200, body = TrialView))
)]
async fn undelete(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
) -> Result<Json<TrialView>> {
    Ok(Json(TrialView::from_trial(app.store().trials().undelete(&id).await?)))
}

/// Returns all trials of a ship.
///
/// # Errors
/// Returns an error if there are too many for one job.
pub(super) async fn all_of_ship(app: &App, ship: &str) -> Result<Vec<Trial>> {
    let (trials, mut all) = (app.store().trials(), Vec::new());
    // The count is checked after each page, so that a ship with very many trials is not read to the
    // end.
    let collect = |rows: Vec<Trial>| {
        all.extend(rows);
        check_trial_count(app, all.len())
    };
    let list = |page| async move { trials.list(ship, &page).await.map_err(Problem::from) };
    visit_pages(list, collect).await?;
    Ok(all)
}

/// Checks the number of trials of one job.
pub(super) fn check_trial_count(app: &App, count: usize) -> Result<()> {
    let most = app.limits().refinement_trials;
    match count <= most {
        true => Ok(()),
        false => Err(Problem::invalid(
            "trials",
            format!("at most {most} trials can be used at a time; list the trials to use"),
        )),
    }
}
