//! Service keys, by which programs are identified.

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use sistership_store::KeyRow;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::users::RolesRequest;
use crate::app::App;
use crate::problem::Result;
use crate::web::field::{KeyPrefix, MomentUs, Remark, UserName};
use crate::web::{DocumentBody, Listing, PageQuery, PathParams, QueryParams};
use sistership_web_support::reply::encode_path;
use sistership_web_support::roles::{RoleRequest, RoleView, parse_grants};

pub(super) fn key_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(list, create))
        .routes(routes!(get, revoke))
        .routes(routes!(set_roles))
}

/// A service key without its secret part.
#[derive(Debug, Serialize, ToSchema)]
struct KeyView {
    /// First characters of the key, after `sis_`.
    prefix: String,
    title: String,
    /// User in whose name it acts.
    user: Option<String>,
    roles: Vec<RoleView>,
    created_us: i64,
    expires_us: Option<i64>,
    revoked_us: Option<i64>,
    /// Time of the last use, to a minute.
    last_used_us: Option<i64>,
}

/// A service key as it is shown once.
#[derive(Debug, Serialize, ToSchema)]
struct NewKeyView {
    /// The whole key: it is not stored, and not shown again.
    key: String,
    /// The rest, as later requests show it.
    about: KeyView,
}

/// A service key to be created.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct KeyRequest {
    /// Purpose.
    #[schema(inline)]
    title: Remark,
    /// User in whose name it acts in the audit; it has its own roles.
    #[schema(inline)]
    user: Option<UserName>,
    /// Roles of the key.
    #[serde(default)]
    roles: Vec<RoleRequest>,
    /// Time at which it expires, microseconds since 1970.
    #[schema(inline)]
    expires_us: Option<MomentUs>,
}

impl KeyView {
    async fn load(app: &App, row: KeyRow) -> Result<Self> {
        let roles =
            app.store().grants().list_by_principal(&KeyRow::principal_name(&row.prefix)).await?;
        let KeyRow {
            prefix,
            title,
            user_name: user,
            created_us,
            expires_us,
            revoked_us,
            last_used_us,
            ..
        } = row;
        let roles = roles.into_iter().map(RoleView::from_row).collect();
        Ok(Self { prefix, title, user, roles, created_us, expires_us, revoked_us, last_used_us })
    }
}

/// List the service keys by prefix, including ended ones
#[utoipa::path(get, path = "/v1/keys", tag = "access", params(PageQuery),
    responses((status = 200, body = Listing<KeyView>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<KeyView>>> {
    let keys = app.store().service_keys().list(&query.requested_page()?).await?;
    let mut items = Vec::new();
    for key in keys.items {
        items.push(KeyView::load(&app, key).await?);
    }
    let next = keys.next.as_ref().and_then(crate::web::page::encode_cursor);
    Ok(Json(Listing { items, next }))
}

/// Create a service key
///
/// The answer has the whole key, once. The request therefore takes no `Idempotency-Key`: the answer
/// that a replay needs would have to store the key.
#[utoipa::path(
    post, path = "/v1/keys", tag = "access", request_body = KeyRequest,
    responses((status = 201, body = NewKeyView, headers(("Location" = String))))
)]
async fn create(State(app): State<App>, payload: DocumentBody) -> Result<Response> {
    let KeyRequest { title, user, roles, expires_us } = payload.parse_json()?;
    // Dates in the past are accepted: such a key is never valid.
    let (user, ends) = (user.map(UserName::into_string), expires_us.map(MomentUs::get));
    let (text, row) = app.accounts().make_key(&title, user, ends, &parse_grants(roles)?).await?;
    let location = encode_path(&["v1", "keys", &row.prefix]);
    let about = KeyView::load(&app, row).await?;
    let view = NewKeyView { key: text.as_str().to_owned(), about };
    // Neither the browser nor a proxy may store the key.
    let head = [(header::LOCATION, location), (header::CACHE_CONTROL, "no-store".to_owned())];
    Ok((StatusCode::CREATED, head, Json(view)).into_response())
}

/// Get a service key
#[utoipa::path(get, path = "/v1/keys/{prefix}", tag = "access",
    params(("prefix" = inline(KeyPrefix), Path)), responses((status = 200, body = KeyView)))]
async fn get(
    State(app): State<App>,
    PathParams(prefix): PathParams<KeyPrefix>,
) -> Result<Json<KeyView>> {
    let key = app.store().service_keys().get(&prefix).await?;
    Ok(Json(KeyView::load(&app, key).await?))
}

/// Revoke a service key permanently
#[utoipa::path(delete, path = "/v1/keys/{prefix}", tag = "access",
    params(("prefix" = inline(KeyPrefix), Path)), responses((status = 200, body = KeyView)))]
async fn revoke(
    State(app): State<App>,
    PathParams(prefix): PathParams<KeyPrefix>,
) -> Result<Json<KeyView>> {
    let key = app.accounts().revoke(&prefix).await?;
    Ok(Json(KeyView::load(&app, key).await?))
}

/// Replace all roles of a service key
#[utoipa::path(
    put, path = "/v1/keys/{prefix}/roles", tag = "access",
    params(("prefix" = inline(KeyPrefix), Path)),
    request_body = RolesRequest, responses((status = 200, body = KeyView))
)]
async fn set_roles(
    State(app): State<App>,
    PathParams(prefix): PathParams<KeyPrefix>,
    payload: DocumentBody,
) -> Result<Json<KeyView>> {
    let RolesRequest { roles } = payload.parse_json()?;
    app.accounts().set_roles(&KeyRow::principal_name(&prefix), &parse_grants(roles)?).await?;
    let key = app.store().service_keys().get(&prefix).await?;
    Ok(Json(KeyView::load(&app, key).await?))
}
