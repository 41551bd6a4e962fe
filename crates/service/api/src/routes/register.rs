//! Registration of versions that were made elsewhere.

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::Deserialize;
use serde_json::Value;
use sistership_model::Model;
use sistership_model::version::FORMAT;
use sistership_store::{ExpectedRevision, NewVersion, StoreError};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::versions::VersionHead;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::{Remark, RequestKey, VersionNumber};
use crate::web::{DocumentBody, IdempotencyKey, Name, PathParams, StoredReply};
use sistership_jobs::aliases::{LATEST, server_move};
use sistership_jobs::error::DeriveError;
use sistership_jobs::recipe::{DerivationRecipe, RegisteredRecipe};
use sistership_jobs::schema::schema_reference;
use sistership_jobs::version::VersionDocument;

const REGISTERED_METHOD: &str = "registered";

pub(super) fn register_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(register))
}

/// A model that was made elsewhere.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct RegisterRequest {
    /// The model, as `models/schema/model.json` describes it and `GET /v1/ships/{ship}/model`
    /// returns it.
    #[schema(schema_with = schema_reference::<Model>)]
    model: Value,
    /// Author and tool; kept in its recipe.
    #[schema(inline)]
    origin: Remark,
    /// Number of the version that it was made from.
    #[schema(inline)]
    parent: Option<VersionNumber>,
}

/// Register a model that was made elsewhere as the next version
///
/// It is checked against its law. It becomes champion only when that alias is moved to it.
#[utoipa::path(
    post, path = "/v1/models/{model}/versions", tag = "models",
    params(
        ("model" = inline(Name), Path, description = "The ship"),
        ("Idempotency-Key" = inline(Option<RequestKey>), Header, description = "Key that makes it safe to repeat the request")
    ),
    request_body = RegisterRequest,
    responses((status = 201, body = VersionHead, headers(("Location" = String))))
)]
async fn register(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    key: IdempotencyKey,
    payload: DocumentBody,
) -> Result<Response> {
    let request: RegisterRequest = payload.parse_json()?;
    key.run_once(&app, payload.bytes(), |app| async move {
        register_version(&app, ship.into_string(), request).await
    })
    .await
}

async fn register_version(
    app: &App,
    ship: String,
    request: RegisterRequest,
) -> Result<StoredReply> {
    let RegisterRequest { model, origin, parent } = request;
    let model: Model = serde_path_to_error::deserialize(model).map_err(|error| {
        let field = format!("model.{}", error.path());
        Problem::invalid(field.trim_end_matches('.'), error.inner().to_string())
    })?;
    if model.ship != ship {
        return Err(Problem::invalid(
            "model.ship",
            format!("is `{}`, but the path says `{ship}`", model.ship),
        ));
    }
    app.store().ships().get(&ship).await?;
    let law_sha256 = check_against_law(app, &model).await?;
    let weights = checked_weights(app, &model).await?;
    let new = NewVersion {
        parent: parent_id(app, &ship, parent.map(VersionNumber::get)).await?,
        law: model.law.clone(),
        method: REGISTERED_METHOD.to_owned(),
        document: version_document(&ship, model, law_sha256, origin.into_string())?,
        model: ship,
        weights,
    };
    // The document does not depend on the number, so that versions made at the same time do no
    // harm.
    let follow = server_move(LATEST, ExpectedRevision::Any, REGISTERED_METHOD);
    let versions = app.store().versions();
    let version = versions.create_with_weights(app.objects(), &new, &[follow]).await?;
    let (model, number) = (version.model.clone(), version.number.to_string());
    let reply = StoredReply::new(StatusCode::CREATED, &VersionHead::from_head(version))?;
    Ok(reply.with_location(&["v1", "models", &model, "versions", &number]))
}

/// Checks a model against its law, and returns the hash of the law's text.
async fn check_against_law(app: &App, model: &Model) -> Result<String> {
    let no_law = || {
        Problem::invalid(
            "model.law",
            format!("there is no law `{}`; GET /v1/laws lists them", model.law),
        )
    };
    let law = app.find_law(&model.law).await?.ok_or_else(no_law)?;
    model
        .check_against(&law.law)
        .map_err(|(field, message)| Problem::invalid(&format!("model.{field}"), message))?;
    Ok(law.sha256)
}

/// Returns the object with the weights of a model's learned correction, which must exist and suit
/// the model.
async fn checked_weights(app: &App, model: &Model) -> Result<Option<String>> {
    let Some(branch) = &model.branch else { return Ok(None) };
    let refuse = |error: DeriveError| match error {
        DeriveError::Store(StoreError::NotFound { .. }) => Problem::invalid(
            "model.branch.weights_sha256",
            "these weights are not on this server; train a learned correction with POST \
             /v1/branches",
        ),
        DeriveError::Join(error) => Problem::invalid("model.branch", error.to_string()),
        other => other.into(),
    };
    // On a copy: the document keeps the hash of the weights, not the weights.
    app.archive().attach_weights(&mut model.clone()).await.map_err(refuse)?;
    Ok(Some(branch.weights_sha256.clone()))
}

async fn parent_id(app: &App, ship: &str, parent: Option<i64>) -> Result<Option<String>> {
    let Some(number) = parent else { return Ok(None) };
    match app.store().versions().get(ship, number).await {
        Err(StoreError::NotFound { .. }) => {
            Err(Problem::invalid("parent", format!("there is no version {ship}/{number}")))
        }
        other => Ok(Some(other?.head.id)),
    }
}

fn version_document(
    ship: &str,
    model: Model,
    law_sha256: String,
    origin: String,
) -> Result<String> {
    let document = VersionDocument {
        format: FORMAT.to_owned(),
        ship: ship.to_owned(),
        recipe: DerivationRecipe::Registered(RegisteredRecipe {
            kind: Default::default(),
            law_sha256,
            origin,
        }),
        model,
        report: Value::Null,
    };
    document.to_canonical_json().map_err(Problem::internal)
}
