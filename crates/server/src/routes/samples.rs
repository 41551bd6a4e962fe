//! The samples of a trial, in canonical units and signs.

use axum::body::Body;
use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use bytes::Bytes;
use sistership_trials::samples::{from_parquet, to_csv};
use tokio_util::io::{ReaderStream, SyncIoBridge};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::document::Binary;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::{Id, Place, accept};

const CSV: &str = "text/csv";
const PARQUET: &str = "application/vnd.apache.parquet";
/// What may lie between the writer of a CSV file and the network.
const PIPE_BYTES: usize = 64 << 10;

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(samples))
}

/// The samples of a trial, as CSV or as Parquet, under canonical names
#[utoipa::path(
    get, path = "/v1/trials/{id}/samples", tag = "trials", params(("id" = inline(Id), Path)),
    responses((status = 200, content((String = "text/csv"), (Binary = "application/vnd.apache.parquet"))))
)]
async fn samples(State(app): State<App>, Place(id): Place<Id>, headers: HeaderMap) -> Result<Response> {
    let media = accept::choose(&headers, &[CSV, PARQUET])?;
    let trial = app.store().trials().get(&id).await?;
    let bytes = app.objects().get(&trial.object_key).await?;
    let body = if media == CSV { csv(&app, bytes).await? } else { Body::from(bytes) };
    Ok(([(header::CONTENT_TYPE, media), (header::VARY, "accept")], body).into_response())
}

/// CSV as it is written: it is never whole in memory.
async fn csv(app: &App, bytes: Bytes) -> Result<Body> {
    let trial = app.compute(move || from_parquet(bytes)).await?.map_err(Problem::internal)?;
    let (reader, writer) = tokio::io::duplex(PIPE_BYTES);
    let writer = SyncIoBridge::new(writer);
    tokio::task::spawn_blocking(move || {
        if let Err(error) = to_csv(writer, &trial) {
            tracing::debug!(%error, "samples were not read to their end");
        }
    });
    Ok(Body::from_stream(ReaderStream::new(reader)))
}
