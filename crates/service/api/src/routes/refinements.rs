//! Requests of refinements.

use axum::extract::State;
use axum::response::Response;
use serde::Deserialize;
use serde_json::Value;
use sistership_identification::refine::{Prior, RefinementSettings, SettingFault};
use sistership_store::{Job, StoreError};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::jobs::JobView;
use super::model_ref::resolve_version;
use super::named_trials::{checked_trials, no_trials};
use super::queue::{enqueue_job, job_reply};
use super::trials::all_of_ship;
use crate::app::App;
use crate::jobs::{RefinementJob, SourceChoice};
use crate::problem::{Problem, Result};
use crate::rights::check_ship_role;
use crate::web::field::RequestKey;
use crate::web::payload::from_slice;
use crate::web::{DocumentBody, Id, IdempotencyKey, ModelName, Name, StoredReply};
use sistership_auth::Role;
use sistership_jobs::schema::schema_reference;

pub(super) fn refinement_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(refine))
}

/// A refinement to be run.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct RefinementRequest {
    /// The ship to refine a model for.
    #[schema(inline)]
    ship: Name,
    /// Source model: `auto` (default), or a version to start from: `ship` (its champion),
    /// `ship/number`, `ship/alias`. If neither a source nor a law nor `settings.method` is given,
    /// all three are selected: the best model that the trials allow, by its error on held-out
    /// manoeuvres. With a law or method, `auto` is the most similar eligible ship.
    #[schema(inline)]
    source: Option<ModelName>,
    /// Law to fit, such as `low-speed`; by default that of the source. For a source with another
    /// law, its forces over the states of the trials and of its standard manoeuvres become the
    /// prior.
    #[schema(inline)]
    law: Option<Name>,
    /// Ids of the trials; by default all of the ship's.
    #[schema(inline, min_items = 1)]
    trials: Option<Vec<Id>>,
    /// Settings of the estimator; each has a default, and all are kept with the version.
    #[serde(default)]
    #[schema(schema_with = schema_reference::<RefinementSettings>)]
    settings: RefinementSettings,
}

/// Name of the source that is selected automatically.
const AUTO: &str = "auto";

/// Refine a model against trials
///
/// The work is a job: follow the `Location`, or its `/events`. Its result is a version of the
/// ship's line, champion if it has none and otherwise `candidate`, with a report. If all is left to
/// the model selection and a learned correction improves on held-out trials, `branch_job` of the
/// result trains it.
#[utoipa::path(
    post, path = "/v1/refinements", tag = "refinements",
    params(("Idempotency-Key" = inline(Option<RequestKey>), Header,
    description = "Key that makes it safe to repeat the request")),
    request_body = RefinementRequest,
    responses((status = 202, body = JobView, headers(("Location" = String))))
)]
async fn refine(
    State(app): State<App>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let request: RefinementRequest = payload.parse_json()?;
    // The search is decided from the raw body: once parsed, a default method looks like a chosen
    // one.
    let search = names_no_method(payload.bytes()) && request.is_open();
    key.run_once(&app, payload.bytes(), move |app| async move {
        queue_reply(&app, request, search).await
    })
    .await
}

/// Queues a refinement that a page requests, from the document that the endpoint takes.
pub(super) async fn queue_from_page(app: &App, asked: &Value) -> Result<Job> {
    let body = serde_json::to_vec(asked).map_err(Problem::internal)?;
    let request: RefinementRequest = from_slice(&body)?;
    let search = names_no_method(&body) && request.is_open();
    queue_job(app, request, search).await
}

impl RefinementRequest {
    /// Returns true if neither source nor law is named, nor another prior, nor settings that only
    /// some methods use.
    fn is_open(&self) -> bool {
        let source = self.source.as_deref().is_none_or(|source| source == AUTO);
        // Constraints and other priors are settings of some methods only, which the model selection
        // would drop.
        let settings = &self.settings;
        let is_source = settings.prior == Prior::Source;
        source && self.law.is_none() && settings.constraints.is_empty() && is_source
    }
}

/// Returns true if the body leaves the method open; the parsed settings have a default and cannot
/// tell.
fn names_no_method(body: &[u8]) -> bool {
    let asked: Value = serde_json::from_slice(body).unwrap_or_default();
    asked.pointer("/settings/method").is_none()
}

async fn queue_reply(app: &App, request: RefinementRequest, search: bool) -> Result<StoredReply> {
    job_reply(app, queue_job(app, request, search).await?).await
}

async fn queue_job(app: &App, request: RefinementRequest, search: bool) -> Result<Job> {
    // The job stores the resolved request, so that later changes of aliases or trials do not affect
    // it.
    let job = RefinementJob { search, ..resolve_request(app, request).await? };
    enqueue_job(app, &job).await
}

/// Looks up everything that the request names, so that a wrong request is refused at once.
async fn resolve_request(app: &App, request: RefinementRequest) -> Result<RefinementJob> {
    let RefinementRequest { ship, source, law, trials, settings } = request;
    check_ship_role(app.store(), Role::Engineer, &ship).await?;
    match app.store().ships().get(&ship).await {
        Err(StoreError::NotFound { .. }) => {
            return Err(Problem::invalid(
                "ship",
                format!("there is no ship `{ship}`; create it with POST /v1/ships"),
            ));
        }
        other => drop(other?),
    }
    // All settings are checked at once, so that one answer names every fault.
    settings.check().map_err(setting_refusal)?;
    check_repeatable(&settings)?;
    check_law(app, law.as_deref()).await?;
    let trials = trial_ids(app, &ship, trials).await?;
    let source = source_choice(app, source.as_deref().unwrap_or(AUTO)).await?;
    Ok(RefinementJob {
        source,
        ship: ship.into_string(),
        law: law.map(Name::into_string),
        search: false,
        trials,
        settings,
    })
}

/// Refusal that names every setting that cannot be used.
fn setting_refusal(faults: Vec<SettingFault>) -> Problem {
    let fault = |SettingFault { field, message }| (format!("settings.{field}"), message);
    Problem::all_invalid(faults.into_iter().map(fault))
}

/// Checks that the version can be derived again from its recipe, which is not so if a clock ends
/// the search.
fn check_repeatable(settings: &RefinementSettings) -> Result<()> {
    let timed = settings
        .cma_es
        .as_ref()
        .is_some_and(|search| search.wall_s.is_some() || search.cpu_s.is_some());
    let message = "a search that is limited by time cannot be reproduced; limit `evaluations` \
                   instead of wall_s and cpu_s";
    if timed { Err(Problem::invalid("settings.cma_es", message)) } else { Ok(()) }
}

/// Checks that a law exists.
async fn check_law(app: &App, law: Option<&str>) -> Result<()> {
    let Some(law) = law else { return Ok(()) };
    match app.store().laws().get(law).await {
        Err(StoreError::NotFound { .. }) => Err(Problem::invalid(
            "law",
            format!("there is no law `{law}`; GET /v1/laws lists the laws"),
        )),
        other => other.map(drop).map_err(Problem::from),
    }
}

async fn source_choice(app: &App, source: &str) -> Result<SourceChoice> {
    if source == AUTO {
        return Ok(SourceChoice::Auto);
    }
    let head = resolve_version(app.store(), "source", source).await?.head;
    Ok(SourceChoice::Version { ship: head.model, number: head.number })
}

async fn trial_ids(app: &App, ship: &str, ids: Option<Vec<Id>>) -> Result<Vec<String>> {
    if let Some(ids) = ids {
        return checked_trials(app, ship, ids, "all of the ship's").await;
    }
    let all: Vec<String> =
        all_of_ship(app, ship).await?.into_iter().map(|trial| trial.id).collect();
    if all.is_empty() { Err(no_trials(ship)) } else { Ok(all) }
}
