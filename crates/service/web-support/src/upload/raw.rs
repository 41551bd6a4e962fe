//! Uploads of one file with canonical columns as the whole body.

use axum::RequestExt as _;
use axum::extract::{Query, Request};
use axum::http::StatusCode;
use futures::TryStreamExt as _;
use serde::Deserialize;
use sistership_model::manifest::ManifestTrial;
use utoipa::IntoParams;

use super::place::UploadPlace;
use super::received::{TrialUpload, canonical_manifest};
use crate::field::{FileName, Name, Positive, Remark};
use crate::problem::{Problem, Result};
use crate::spool::spool_stream;

/// Default name of a trial.
const UNNAMED: &str = "trial";

/// Query of an upload without a manifest.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub struct RawQuery {
    /// The ship; required for a body that is one file, and ignored for a form.
    #[param(inline, required = false)]
    pub ship: Name,
    /// Name of the trial [default: `trial`].
    #[param(inline)]
    pub name: Option<FileName>,
    /// Manoeuvre of the trial, such as `zigzag 10/10`.
    #[param(inline)]
    pub manoeuvre: Option<Remark>,
    /// Water depth, m; absent for deep water.
    #[param(inline)]
    pub depth_m: Option<Positive>,
    /// `false` skips the diagnosis of the ship's champion on these trials; applies to every form of
    /// upload.
    pub diagnose: Option<bool>,
}

pub(super) async fn receive_file(mut request: Request, place: &UploadPlace) -> Result<TrialUpload> {
    let Query(query) = request.extract_parts::<Query<RawQuery>>().await?;
    let RawQuery { ship, name, manoeuvre, depth_m, diagnose } = query;
    let file = name.map_or_else(|| UNNAMED.to_owned(), FileName::into_string);
    let (manoeuvre, depth_m) = (manoeuvre.map(Remark::into_string), depth_m.map(Positive::get));
    let manifest = canonical_manifest(
        ship.into_string(),
        vec![ManifestTrial { manoeuvre, depth_m, ..ManifestTrial::from_file_name(file) }],
    )?;
    let stream = request.with_limited_body().into_body().into_data_stream().map_err(body_problem);
    let files = vec![spool_stream(&place.spool, stream).await?];
    Ok(TrialUpload::from_files(manifest, diagnose.unwrap_or(true), files))
}

/// Returns the problem of a body that is too large or broke off.
fn body_problem(error: axum::Error) -> Problem {
    let text = error.to_string();
    match text.contains("length limit") {
        true => Problem::new(
            StatusCode::PAYLOAD_TOO_LARGE,
            "the file is larger than this server accepts; send it as Parquet, or in parts",
        ),
        false => Problem::bad_request(format!("the body is incomplete: {text}")),
    }
}
