//! Uploads of trials: streamed to files, read and checked there, and kept all together or not at
//! all.

mod arrived;
mod keep;
mod multipart;
mod raw;
mod received;
mod room;

use axum::extract::{FromRequest, Query, Request};
use axum::http::StatusCode;
use serde::Deserialize;

pub(crate) use keep::{Kept, keep};
pub(crate) use raw::RawQuery;
pub(crate) use received::Upload;
pub(crate) use sistership_http::spool::{Spooled, hex, spool, unwritten};

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::payload::{media, plain};

/// Bodies that are one file.
const FILE_MEDIA: [&str; 3] = ["text/csv", "application/vnd.apache.parquet", "application/parquet"];
impl FromRequest<App> for Upload {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self> {
        plain(request.headers())?;
        match media(request.headers()).as_str() {
            "multipart/form-data" => {
                let Query(Wish { diagnose }) = Query::try_from_uri(request.uri())?;
                Ok(Self {
                    diagnose: diagnose.unwrap_or(true),
                    ..multipart::receive(request, app).await?
                })
            }
            other if FILE_MEDIA.contains(&other) => raw::receive(request, app).await,
            other => Err(Problem::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, unknown(other))),
        }
    }
}

/// What the query of a form says; the rest is in the form.
#[derive(Debug, Deserialize)]
struct Wish {
    diagnose: Option<bool>,
}

fn unknown(media: &str) -> String {
    let found = if media.is_empty() { "nothing".to_owned() } else { format!("`{media}`") };
    format!(
        "Content-Type is {found}; send multipart/form-data with a part `manifest` and the files that it lists, or one file as {}",
        FILE_MEDIA.join(" or ")
    )
}
