//! Trials, to upload and to check.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::binary::Binary;
use super::trials::TrialView;
use crate::app::App;
use crate::problem::Result;
use crate::upload::{Kept, RawQuery, Upload, checked, keep};
use crate::web::field::RequestKey;
use crate::web::{Key, Reply};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(upload)).routes(routes!(check))
}

/// What an upload has brought.
#[derive(Debug, Serialize, ToSchema)]
struct Uploaded {
    ship: String,
    /// The trials, in the manifest's order; samples that were there already give the trial that is
    /// there.
    trials: Vec<TrialView>,
    /// How many of them are new.
    new: usize,
    /// The job that diagnoses the ship's champion on the new ones; none where it has no champion.
    diagnosis: Option<String>,
}

/// The parts of a form.
#[derive(ToSchema)]
#[allow(dead_code, reason = "it only describes the form")]
struct Form {
    /// The trial manifest, YAML (`models/schema/trials.json`).
    manifest: Option<String>,
    /// The ship, instead of a manifest, for files with canonical columns.
    ship: Option<String>,
    /// One part for each file; its filename is the path in the manifest.
    #[schema(value_type = Vec<String>, format = Binary)]
    file: Vec<Vec<u8>>,
}

/// Upload trials, all together or none
///
/// A form with a manifest and its files, or one CSV or Parquet file with canonical columns. Units
/// and signs are converted once, here; what the checks refuse is told with file, row and column.
/// Where the ship has a champion, a job follows that diagnoses it on the new trials, unless
/// `diagnose=false`.
#[utoipa::path(
    post, path = "/v1/trials", tag = "trials",
    params(RawQuery,
    ("Idempotency-Key" = inline(Option<RequestKey>), Header, description = "Repeat the request safely under this key")),
    request_body(content((Form = "multipart/form-data"), (String = "text/csv"),
    (Binary = "application/vnd.apache.parquet"))),
    responses((status = 201, body = Uploaded, headers(("Location" = String))))
)]
async fn upload(State(app): State<App>, key: Key, upload: Upload) -> Result<Response> {
    let fingerprint = upload.fingerprint()?;
    key.once(&app, fingerprint.as_bytes(), |app| async move { kept(&app, upload).await }).await
}

async fn kept(app: &App, upload: Upload) -> Result<Reply> {
    let ship = upload.ship().to_owned();
    let (kept, job): (Vec<Kept>, _) = keep(app, upload).await?;
    let only = match kept.as_slice() {
        [only] => Some(only.row.id.clone()),
        _ => None,
    };
    let new = kept.iter().filter(|trial| trial.new).count();
    let trials = kept.into_iter().map(|trial| TrialView::of(trial.row)).collect();
    let uploaded = Uploaded { ship, trials, new, diagnosis: job.map(|job| job.id) };
    let reply = Reply::new(StatusCode::CREATED, &uploaded)?.with_jobs();
    Ok(match only {
        Some(id) => reply.at(&["v1", "trials", &id]),
        None => reply.at_list(&["v1", "trials"], ("ship", &uploaded.ship)),
    })
}

/// Check trials without keeping them
///
/// The same body as for an upload; the ship need not exist. The answer is that of `sistership check
/// --json`.
#[utoipa::path(
    post, path = "/v1/trials/check", tag = "trials", params(RawQuery),
    request_body(content((Form = "multipart/form-data"), (String = "text/csv"),
    (Binary = "application/vnd.apache.parquet"))),
    responses((status = 200, body = Object, description = "`trials`: `file`, `rows`, `duration_s`, \
        `errors`, `warnings` of each"))
)]
async fn check(State(app): State<App>, upload: Upload) -> Result<Json<Value>> {
    let outcomes = checked(&upload, &app).await?;
    Ok(Json(json!({ "trials": outcomes })))
}
