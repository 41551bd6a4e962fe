//! Samples of a trial, in canonical units and signs.

use std::fs::File;

use axum::BoxError;
use axum::body::Body;
use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use bytes::Bytes;
use futures::stream::BoxStream;
use futures::{Stream, StreamExt as _};
use sha2::{Digest as _, Sha256};
use sistership_auth::to_hex;
use sistership_store::ObjectsError;
use sistership_trials::samples::CsvPieces;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::binary::Binary;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::upload::spool_stream;
use crate::web::{Id, PathParams, accept};
use sistership_jobs::budget::{self, MemoryShare};

const CSV: &str = "text/csv";
const PARQUET: &str = "application/vnd.apache.parquet";
/// Memory for the samples of a CSV file while it is sent, bytes: a page of each column, encoded and
/// decoded.
const DECODING_BYTES: u64 = 4 << 20;

pub(super) fn sample_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(samples))
}

/// Get the samples of a trial, as CSV or as Parquet, under canonical names
#[utoipa::path(
    get, path = "/v1/trials/{id}/samples", tag = "trials", params(("id" = inline(Id), Path)),
    responses((status = 200,
    content((String = "text/csv"), (Binary = "application/vnd.apache.parquet"))))
)]
async fn samples(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    headers: HeaderMap,
) -> Result<Response> {
    let media = accept::choose_media(&headers, &[CSV, PARQUET])?;
    let trial = app.store().trials().get(&id).await?;
    let (size, stream) = app.objects().get_stream(&trial.object_key).await?;
    let types = [(header::CONTENT_TYPE, media), (header::VARY, "accept")];
    if media == CSV {
        return Ok((types, csv_body(&app, &trial.object_key, stream).await?).into_response());
    }
    let body = Body::from_stream(verify_stream(trial.object_key, stream));
    Ok((types, [(header::CONTENT_LENGTH, size)], body).into_response())
}

/// Passes the bytes on as they come; if their hash differs from `key`, the answer breaks off before
/// its end.
fn verify_stream(
    key: String,
    mut bytes: ByteStream,
) -> impl Stream<Item = std::result::Result<Bytes, BoxError>> + Send {
    async_stream::try_stream! {
        // The last piece is held back until the hash is known, so that a damaged object never looks
        // complete.
        let (mut hash, mut held) = (Sha256::new(), Bytes::new());
        while let Some(next) = bytes.next().await {
            let next = next?;
            hash.update(&next);
            let before = std::mem::replace(&mut held, next);
            if !before.is_empty() {
                yield before;
            }
        }
        check_hash(&key, &to_hex(&hash.finalize()))?;
        yield held;
    }
}

type ByteStream = BoxStream<'static, sistership_store::Result<Bytes>>;

fn check_hash(key: &str, actual: &str) -> std::result::Result<(), BoxError> {
    if key == actual {
        Ok(())
    } else {
        Err(ObjectsError::Damaged { key: key.into(), actual: actual.into() }.into())
    }
}

/// Returns the samples as CSV, decoded some rows at a time from disk: nothing waits in memory for a
/// client that does not read.
async fn csv_body(app: &App, key: &str, bytes: ByteStream) -> Result<Body> {
    let share = budget::reserve_share(DECODING_BYTES).await?;
    let spooled = spool_stream(app.spool(), bytes).await?;
    check_hash(key, &spooled.sha256).map_err(Problem::internal)?;
    let open = move || CsvPieces::open(File::open(&spooled.path)?).map_err(BoxError::from);
    let pieces = app.run_blocking(open).await?.map_err(Problem::internal)?;
    // The share of memory travels with the reader and is given back when either ends.
    let next = |(mut pieces, share): (CsvPieces, Option<MemoryShare>)| async move {
        let decode = move || {
            pieces
                .next_piece()
                .map(|piece| piece.map(|piece| (Bytes::from(piece), (pieces, share))))
        };
        tokio::task::spawn_blocking(decode).await.map_err(BoxError::from)?.map_err(BoxError::from)
    };
    Ok(Body::from_stream(futures::stream::try_unfold((pieces, share), next)))
}
