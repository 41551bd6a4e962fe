//! Users, and the caller.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use sistership_store::{IdentityRow, User};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::{AuthenticationKind, current_actor};
use crate::web::field::{Line, Password, Remark, RequestKey, UserName};
use crate::web::{
    DocumentBody, IdempotencyKey, Listing, PageQuery, PathParams, QueryParams, StoredReply,
};
use sistership_web_support::roles::{RoleRequest, RoleView, parse_grants};

pub(super) fn user_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(me))
        .routes(routes!(list, create))
        .routes(routes!(get, disable))
        .routes(routes!(enable))
        .routes(routes!(set_password))
        .routes(routes!(set_roles))
        .routes(routes!(set_identities))
}

/// The caller.
#[derive(Debug, Serialize, ToSchema)]
struct Me {
    /// Name in the audit: a user, `key:PREFIX`, `server-key`, or `local` on a server that does not
    /// identify its callers.
    name: String,
    /// `user`, `key`, `server-key` or `local`.
    kind: &'static str,
    roles: Vec<RoleView>,
}

/// A user.
#[derive(Debug, Serialize, ToSchema)]
struct UserView {
    name: String,
    title: String,
    roles: Vec<RoleView>,
    /// False if the user is disabled.
    enabled: bool,
    /// True if the user can sign in by a password.
    has_password: bool,
    /// Identities of the user at OpenID providers.
    identities: Vec<IdentityView>,
    created_us: i64,
}

/// An identity at an OpenID provider.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct IdentityRequest {
    /// URL of the provider.
    #[schema(inline)]
    issuer: Line,
    /// Name of the user at the provider: its claim `sub`.
    #[schema(inline)]
    subject: Line,
}

/// An identity at an OpenID provider.
#[derive(Debug, Serialize, ToSchema)]
struct IdentityView {
    issuer: String,
    subject: String,
}

/// Identities that replace all others.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct IdentitiesRequest {
    /// The identities; without any, no provider knows the user.
    identities: Vec<IdentityRequest>,
}

/// A user to be created.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct UserRequest {
    /// User name; it cannot be changed later.
    #[schema(inline)]
    name: UserName,
    /// Display name; by default the name.
    #[schema(inline)]
    title: Option<Remark>,
    /// First password; without one the user cannot sign in yet.
    #[schema(inline)]
    password: Option<Password>,
    /// Roles of the user.
    #[serde(default)]
    roles: Vec<RoleRequest>,
}

/// A new password.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct PasswordRequest {
    /// The password.
    #[schema(inline)]
    password: Password,
}

/// Roles that replace all others.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RolesRequest {
    /// The roles; an empty list removes every right.
    pub roles: Vec<RoleRequest>,
}

impl UserView {
    async fn load(app: &App, user: User) -> Result<Self> {
        let roles =
            app.store().grants().list_by_principal(&User::principal_name(&user.name)).await?;
        // The answer says whether there is a password; its hash stays internal.
        let (enabled, has_password) = (user.is_enabled(), user.password_hash.is_some());
        let identities = app.store().identities().list_by_user(&user.name).await?;
        let identity = |IdentityRow { issuer, subject, .. }| IdentityView { issuer, subject };
        let identities = identities.into_iter().map(identity).collect();
        let User { name, title, created_us, .. } = user;
        let roles = roles.into_iter().map(RoleView::from_row).collect();
        Ok(Self { name, title, roles, enabled, has_password, identities, created_us })
    }
}

/// Get the caller and its roles
#[utoipa::path(get, path = "/v1/me", tag = "access", responses((status = 200, body = Me)))]
async fn me() -> Result<Json<Me>> {
    let acting = current_actor().ok_or_else(|| {
        Problem::internal("the request has no user or key; sign in, or send a key")
    })?;
    let kind = match acting.principal.kind {
        AuthenticationKind::Local => "local",
        AuthenticationKind::ServerKey => "server-key",
        AuthenticationKind::Key => "key",
        AuthenticationKind::Session { .. } => "user",
    };
    let roles = acting.principal.rights.grants().iter().map(RoleView::from_grant).collect();
    Ok(Json(Me { name: acting.principal.name.clone(), kind, roles }))
}

/// List the users by name
#[utoipa::path(get, path = "/v1/users", tag = "access", params(PageQuery),
    responses((status = 200, body = Listing<UserView>)))]
async fn list(
    State(app): State<App>,
    QueryParams(query): QueryParams<PageQuery>,
) -> Result<Json<Listing<UserView>>> {
    let users = app.store().users().list(&query.requested_page()?).await?;
    let mut items = Vec::new();
    for user in users.items {
        items.push(UserView::load(&app, user).await?);
    }
    let next = users.next.as_ref().and_then(crate::web::page::encode_cursor);
    Ok(Json(Listing { items, next }))
}

/// Create a user
#[utoipa::path(
    post, path = "/v1/users", tag = "access",
    params(("Idempotency-Key" = inline(Option<RequestKey>), Header,
    description = "Key that makes it safe to repeat the request")),
    request_body = UserRequest,
    responses((status = 201, body = UserView, headers(("Location" = String))))
)]
async fn create(
    State(app): State<App>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let request: UserRequest = payload.parse_json()?;
    key.run_once(&app, payload.bytes(), |app| async move { create_user(&app, request).await }).await
}

async fn create_user(app: &App, request: UserRequest) -> Result<StoredReply> {
    let UserRequest { name, title, password, roles } = request;
    let title = title.map_or_else(|| name.to_string(), Remark::into_string);
    // Roles are checked before the password is hashed, which takes memory and time.
    let roles = parse_grants(roles)?;
    let user = app.accounts().create_user(&name, &title, password.as_deref(), &roles).await?;
    let name = user.name.clone();
    let reply = StoredReply::new(StatusCode::CREATED, &UserView::load(app, user).await?)?;
    Ok(reply.with_location(&["v1", "users", &name]))
}

/// Get a user
#[utoipa::path(get, path = "/v1/users/{user}", tag = "access",
    params(("user" = inline(UserName), Path)), responses((status = 200, body = UserView)))]
async fn get(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
) -> Result<Json<UserView>> {
    let user = app.store().users().get(&name).await?;
    Ok(Json(UserView::load(&app, user).await?))
}

/// Disable a user: all sessions end and all rights are suspended; the name stays taken
#[utoipa::path(delete, path = "/v1/users/{user}", tag = "access",
    params(("user" = inline(UserName), Path)), responses((status = 200, body = UserView)))]
async fn disable(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
) -> Result<Json<UserView>> {
    // The user is disabled, not deleted: the audit refers to the name.
    let user = app.accounts().set_enabled(&name, false).await?;
    Ok(Json(UserView::load(&app, user).await?))
}

/// Enable a disabled user, with the same rights as before
#[utoipa::path(post, path = "/v1/users/{user}/enable", tag = "access",
    params(("user" = inline(UserName), Path)), responses((status = 200, body = UserView)))]
async fn enable(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
) -> Result<Json<UserView>> {
    let user = app.accounts().set_enabled(&name, true).await?;
    Ok(Json(UserView::load(&app, user).await?))
}

/// Set the password of a user, which ends all sessions
#[utoipa::path(
    put, path = "/v1/users/{user}/password", tag = "access",
    params(("user" = inline(UserName), Path)),
    request_body = PasswordRequest, responses((status = 204, description = "It is set"))
)]
async fn set_password(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
    payload: DocumentBody,
) -> Result<StatusCode> {
    let PasswordRequest { password } = payload.parse_json()?;
    app.accounts().set_password(&name, &password).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Replace all roles of a user
#[utoipa::path(
    put, path = "/v1/users/{user}/roles", tag = "access", params(("user" = inline(UserName), Path)),
    request_body = RolesRequest, responses((status = 200, body = UserView))
)]
async fn set_roles(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
    payload: DocumentBody,
) -> Result<Json<UserView>> {
    let RolesRequest { roles } = payload.parse_json()?;
    app.accounts().set_roles(&User::principal_name(&name), &parse_grants(roles)?).await?;
    let user = app.store().users().get(&name).await?;
    Ok(Json(UserView::load(&app, user).await?))
}

/// Replace all identities of a user at OpenID providers
#[utoipa::path(
    put, path = "/v1/users/{user}/identities", tag = "access",
    params(("user" = inline(UserName), Path)),
    request_body = IdentitiesRequest, responses((status = 200, body = UserView))
)]
async fn set_identities(
    State(app): State<App>,
    PathParams(name): PathParams<UserName>,
    payload: DocumentBody,
) -> Result<Json<UserView>> {
    let IdentitiesRequest { identities } = payload.parse_json()?;
    let pair = |one: IdentityRequest| (one.issuer.into_string(), one.subject.into_string());
    let those: Vec<(String, String)> = identities.into_iter().map(pair).collect();
    app.store().identities().replace_identities(&name, &those).await?;
    // A principal in the cache might act under an identity that is gone.
    app.accounts().clear_cache();
    let user = app.store().users().get(&name).await?;
    Ok(Json(UserView::load(&app, user).await?))
}
