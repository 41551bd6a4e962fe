//! Uploads of trials: streamed to files, with a manifest that describes them.

mod arrived;
mod multipart;
mod place;
mod raw;
mod received;

use axum::extract::{FromRef, FromRequest, Query, Request};
use axum::http::StatusCode;
use serde::Deserialize;

pub use arrived::UploadedTrial;
pub use place::UploadPlace;
pub use raw::RawQuery;
pub use received::TrialUpload;

use crate::payload::{check_uncompressed, media_type};
use crate::problem::{Problem, Result};

/// Media types of a body that is one file.
const FILE_MEDIA: [&str; 3] = ["text/csv", "application/vnd.apache.parquet", "application/parquet"];

impl<S: Send + Sync> FromRequest<S> for TrialUpload
where
    UploadPlace: FromRef<S>,
{
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self> {
        let place = UploadPlace::from_ref(state);
        check_uncompressed(request.headers())?;
        match media_type(request.headers()).as_str() {
            "multipart/form-data" => {
                let Query(UploadQuery { diagnose }) = Query::try_from_uri(request.uri())?;
                Ok(Self {
                    diagnose: diagnose.unwrap_or(true),
                    ..multipart::receive_form(request, &place).await?
                })
            }
            other if FILE_MEDIA.contains(&other) => raw::receive_file(request, &place).await,
            other => Err(Problem::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, unknown_media(other))),
        }
    }
}

/// Query of an upload as a form; its other fields are in the form.
#[derive(Debug, Deserialize)]
struct UploadQuery {
    diagnose: Option<bool>,
}

fn unknown_media(media: &str) -> String {
    let found = if media.is_empty() { "nothing".to_owned() } else { format!("`{media}`") };
    format!(
        "Content-Type is {found}; send multipart/form-data with a part `manifest` and the files \
         that it lists, or one file as {}",
        FILE_MEDIA.join(" or ")
    )
}
