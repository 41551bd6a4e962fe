//! One file with canonical columns as the whole body.

use axum::RequestExt as _;
use axum::extract::{Query, Request};
use axum::http::StatusCode;
use futures::TryStreamExt as _;
use serde::Deserialize;
use sistership_model::manifest::ManifestTrial;
use utoipa::IntoParams;

use super::spool::spool;
use super::{Upload, canonical};
use crate::app::App;
use crate::problem::{Problem, Result};

/// What is known of a file that comes without a manifest.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(crate) struct RawQuery {
    /// The ship; needed for a body that is one file, as the others are only read then.
    #[param(required = false)]
    pub ship: String,
    /// What to call the trial; `trial` where absent.
    #[serde(default = "unnamed")]
    pub name: String,
    /// What was sailed, such as `zigzag 10/10`.
    pub manoeuvre: Option<String>,
    /// Water depth, m; absent for deep water.
    pub depth_m: Option<f64>,
    /// `false` where the ship's champion is not to be diagnosed on these trials; read for every form of upload.
    pub diagnose: Option<bool>,
}

fn unnamed() -> String {
    "trial".to_owned()
}

pub(super) async fn receive(mut request: Request, app: &App) -> Result<Upload> {
    let Query(query) = request.extract_parts::<Query<RawQuery>>().await?;
    let RawQuery { ship, name, manoeuvre, depth_m, diagnose } = query;
    let manifest = canonical(ship, vec![ManifestTrial { file: name, manoeuvre, depth_m }])?;
    let stream = request.with_limited_body().into_body().into_data_stream().map_err(interrupted);
    Ok(Upload { manifest, diagnose: diagnose.unwrap_or(true), files: vec![spool(app.spool(), stream).await?] })
}

/// Too much was sent, or the caller hung up.
fn interrupted(error: axum::Error) -> Problem {
    let text = error.to_string();
    match text.contains("length limit") {
        true => Problem::new(
            StatusCode::PAYLOAD_TOO_LARGE,
            "the file is larger than this server takes; send it as Parquet, or in parts",
        ),
        false => Problem::bad_request(format!("the body broke off: {text}")),
    }
}
