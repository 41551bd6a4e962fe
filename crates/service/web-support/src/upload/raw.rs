//! Uploads of one file with canonical columns as the whole body.

use axum::RequestExt as _;
use axum::extract::{Query, Request};
use axum::http::StatusCode;
use futures::TryStreamExt as _;
use serde::Deserialize;
use sistership_model::manifest::ManifestTrial;
use sistership_trials::{ManifestFile, TrialCurrent};
use utoipa::IntoParams;

use super::place::UploadPlace;
use super::received::{TrialUpload, canonical_manifest};
use crate::field::{CurrentComponent, FileName, Name, Positive, Remark};
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
    /// Propeller revolutions, 1/s, held throughout the trial, where the file records none.
    #[param(inline)]
    pub n_rps: Option<Positive>,
    /// Velocity of the water to the north, m/s, which is subtracted [default: 0].
    #[param(inline)]
    pub current_north_m_s: Option<CurrentComponent>,
    /// Velocity of the water to the east, m/s, which is subtracted [default: 0].
    #[param(inline)]
    pub current_east_m_s: Option<CurrentComponent>,
    /// `false` skips the diagnosis of the ship's champion on these trials; applies to every form of
    /// upload.
    pub diagnose: Option<bool>,
}

pub(super) async fn receive_file(mut request: Request, place: &UploadPlace) -> Result<TrialUpload> {
    let Query(query) = request.extract_parts::<Query<RawQuery>>().await?;
    let diagnose = query.diagnose.unwrap_or(true);
    let manifest = raw_manifest(query)?;
    let stream = request.with_limited_body().into_body().into_data_stream().map_err(body_problem);
    let files = vec![spool_stream(&place.spool, stream).await?];
    Ok(TrialUpload::from_files(manifest, diagnose, files))
}

/// Returns the manifest of the one file.
fn raw_manifest(query: RawQuery) -> Result<ManifestFile> {
    let current = query.current();
    let RawQuery { ship, name, manoeuvre, depth_m, n_rps, .. } = query;
    let file = name.map_or_else(|| UNNAMED.to_owned(), FileName::into_string);
    let trial = ManifestTrial {
        manoeuvre: manoeuvre.map(Remark::into_string),
        depth_m: depth_m.map(Positive::get),
        n_rps: n_rps.map(Positive::get),
        ..ManifestTrial::from_file_name(file)
    };
    let current = current.map(|(north_m_s, east_m_s)| TrialCurrent {
        trial: trial.trial_label(),
        north_m_s,
        east_m_s,
        why: "given with the upload".to_owned(),
    });
    let mut manifest: ManifestFile = canonical_manifest(ship.into_string(), vec![trial])?.into();
    manifest.declarations.currents.extend(current);
    Ok(manifest)
}

impl RawQuery {
    /// Returns the velocity of the current to north and east, if a component is given.
    fn current(&self) -> Option<(f64, f64)> {
        let (north, east) = (self.current_north_m_s, self.current_east_m_s);
        let of = |component: Option<CurrentComponent>| component.map_or(0.0, CurrentComponent::get);
        (north.is_some() || east.is_some()).then(|| (of(north), of(east)))
    }
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
