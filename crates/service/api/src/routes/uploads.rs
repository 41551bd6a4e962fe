//! Upload and check of trials.

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
use crate::upload::{RawQuery, StoredTrial, TrialUpload, check_upload, store_upload};
use crate::web::field::RequestKey;
use crate::web::{IdempotencyKey, StoredReply};

pub(super) fn upload_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(upload)).routes(routes!(check))
}

/// Result of an upload.
#[derive(Debug, Serialize, ToSchema)]
struct UploadResult {
    ship: String,
    /// The trials, in the order of the manifest; samples that were stored before give the existing
    /// trial.
    trials: Vec<TrialView>,
    /// Number of new trials.
    new: usize,
    /// The job that diagnoses the ship's champion on the new trials; null if it has no champion.
    diagnosis: Option<String>,
}

/// Parts of the form.
#[derive(ToSchema)]
#[allow(dead_code, reason = "describes the form only")]
struct Form {
    /// Trial manifest, YAML (`models/schema/trials.json`).
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
/// and signs are converted once, here; refusals name file, row and column. If the ship has a
/// champion, a job follows that diagnoses it on the new trials, unless `diagnose=false`.
#[utoipa::path(
    post, path = "/v1/trials", tag = "trials",
    params(RawQuery,
    ("Idempotency-Key" = inline(Option<RequestKey>), Header, description = "Key that makes it safe to repeat the request")),
    request_body(content((Form = "multipart/form-data"), (String = "text/csv"),
    (Binary = "application/vnd.apache.parquet"))),
    responses((status = 201, body = UploadResult, headers(("Location" = String))))
)]
async fn upload(
    State(app): State<App>,
    key: IdempotencyKey,
    upload: TrialUpload,
) -> Result<Response> {
    // The fingerprint stands for the files when the request is compared with an earlier one.
    let fingerprint = upload.fingerprint()?;
    key.run_once(
        &app,
        fingerprint.as_bytes(),
        |app| async move { upload_reply(&app, upload).await },
    )
    .await
}

async fn upload_reply(app: &App, upload: TrialUpload) -> Result<StoredReply> {
    let ship = upload.ship().to_owned();
    let (kept, job): (Vec<StoredTrial>, _) = store_upload(app, upload).await?;
    // With a single trial the answer refers to it, otherwise to the list of the ship.
    let only = match kept.as_slice() {
        [only] => Some(only.row.id.clone()),
        _ => None,
    };
    let new = kept.iter().filter(|trial| trial.new).count();
    let trials = kept.into_iter().map(|trial| TrialView::from_trial(trial.row)).collect();
    let uploaded = UploadResult { ship, trials, new, diagnosis: job.map(|job| job.id) };
    let reply = StoredReply::new(StatusCode::CREATED, &uploaded)?;
    Ok(match only {
        Some(id) => reply.with_location(&["v1", "trials", &id]),
        None => reply.with_list_location(&["v1", "trials"], ("ship", &uploaded.ship)),
    })
}

/// Check trials without storing them
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
async fn check(State(app): State<App>, upload: TrialUpload) -> Result<Json<Value>> {
    let outcomes = check_upload(&upload, &app).await?;
    Ok(Json(json!({ "trials": outcomes })))
}
