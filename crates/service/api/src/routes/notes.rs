//! Notes about ships.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use sistership_store::ShipNote;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::Result;
use crate::web::field::{Remark, RequestKey};
use crate::web::{
    DocumentBody, IdempotencyKey, Listing, Name, PageQuery, PathParams, QueryParams, StoredReply,
};

pub(super) fn note_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(list, add))
}

/// A note about a ship.
#[derive(Debug, Serialize, ToSchema)]
struct NoteView {
    /// Number of its entry in the audit.
    number: i64,
    at_us: i64,
    /// Author: a user, `key:PREFIX`, `server-key`, `local`, `command-line`.
    actor: String,
    text: String,
}

/// A note to be added.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct NewNote {
    /// Text, of one or several lines.
    #[schema(inline)]
    text: Remark,
}

/// The note that was added.
#[derive(Debug, Serialize, ToSchema)]
struct NoteReceipt<'a> {
    ship: &'a str,
    text: &'a str,
}

impl NoteView {
    fn from_note(note: ShipNote) -> Self {
        let ShipNote { number, at_us, actor, text } = note;
        Self { number, at_us, actor, text }
    }
}

/// List the notes about a ship, the latest first
#[utoipa::path(
    get, path = "/v1/ships/{ship}/notes", tag = "ships",
    params(("ship" = inline(Name), Path), PageQuery),
    responses((status = 200, body = Listing<NoteView>))
)]
async fn list(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<NoteView>>> {
    app.store().ships().get(&ship).await?;
    let notes = app.store().ships().list_notes(&ship, &query.requested_page()?).await?;
    Ok(Json(Listing::from_list(notes, NoteView::from_note)))
}

/// Add a note about a ship; notes are part of the audit and cannot be removed
#[utoipa::path(
    post, path = "/v1/ships/{ship}/notes", tag = "ships",
    params(
        ("ship" = inline(Name), Path),
        ("Idempotency-Key" = inline(Option<RequestKey>), Header,
        description = "Key that makes it safe to repeat the request"),
    ),
    request_body = NewNote,
    responses((status = 201, body = NoteReceipt))
)]
async fn add(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let new: NewNote = payload.parse_json()?;
    let work = |app: App| async move {
        app.store().ships().add_note(&ship, &new.text).await?;
        StoredReply::new(StatusCode::CREATED, &NoteReceipt { ship: &ship, text: &new.text })
    };
    key.run_once(&app, payload.bytes(), work).await
}
