//! The model of a ship, which is the central query of the service.

use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use bytes::Bytes;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sistership_model::Model;
use sistership_store::CurrentVersion;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::versions::VersionHead;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::conditions::entity_tag;
use crate::web::field::EntityTags;
use crate::web::{Name, PathParams, QueryParams, RequestConditions, accept};
use sistership_jobs::aliases::CHAMPION;
use sistership_jobs::archive::version_document;
use sistership_web_support::answers::CachedAnswer;

const JSON: &str = "application/json";
const YAML: &str = "application/yaml";

pub(super) fn champion_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(champion))
}

/// The champion of a ship.
#[derive(Debug, Serialize, ToSchema)]
struct Champion {
    ship: String,
    /// The version that the alias `champion` refers to.
    version: VersionHead,
    /// The model, as `models/schema/model.json` describes it.
    #[schema(value_type = Object)]
    model: Value,
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct ChampionQuery {
    /// `json` or `yaml`; takes precedence over `Accept`.
    #[param(inline)]
    format: Option<Format>,
}

#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
enum Format {
    Json,
    Yaml,
}

/// Get the model of a ship: its champion
///
/// The YAML form is a file that `sistership simulate --model` reads.
#[utoipa::path(
    get, path = "/v1/ships/{ship}/model", tag = "ships",
    params(("ship" = inline(Name), Path), ChampionQuery,
        ("If-None-Match" = inline(Option<EntityTags>), Header, description = "ETag of the copy that you have")),
    responses(
        (status = 200, content((Champion = "application/json"), (String = "application/yaml")),
        headers(("ETag" = String))),
        (status = 304, description = "Your copy is current")
    )
)]
async fn champion(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
    QueryParams(query): QueryParams<ChampionQuery>,
    conditions: RequestConditions,
    headers: HeaderMap,
) -> Result<Response> {
    // A format in the query takes precedence over `Accept`.
    let media = match query.format {
        Some(Format::Json) => JSON,
        Some(Format::Yaml) => YAML,
        None => accept::choose_media(&headers, &[JSON, YAML])?,
    };
    // A ship without champion gets advice; an unknown ship gets its own error.
    let Some(current) = app.store().versions().current_version(&ship, CHAMPION).await? else {
        return Err(no_champion(&app, &ship).await);
    };
    let CachedAnswer { etag, body } = cached_answer(&app, current, media).await?;
    let known = etag.to_str().is_ok_and(|etag| conditions.matches_current(etag));
    let (vary, media) = (HeaderValue::from_static("accept"), HeaderValue::from_static(media));
    let head = [(header::ETAG, etag), (header::VARY, vary), (header::CONTENT_TYPE, media)];
    Ok(if known {
        (StatusCode::NOT_MODIFIED, head).into_response()
    } else {
        (head, body).into_response()
    })
}

/// Returns the answer, from the cache if the version was requested before.
async fn cached_answer(
    app: &App,
    current: CurrentVersion,
    media: &'static str,
) -> Result<CachedAnswer> {
    // A version never changes, so that its answer stays valid; the report is part of the key, as it
    // may be added later.
    let key = (current.id, current.report, media);
    if let Some(answer) = app.champion_cache().get(&key) {
        return Ok(answer);
    }
    let version = app.store().versions().by_id(&key.0).await?;
    let (model, sha256) = (version_document(&version)?.model, &version.head.sha256);
    // The two forms need different tags: caches must not confuse them.
    let (etag, body) = match media {
        YAML => (entity_tag(format!("{sha256}.yaml")), yaml_body(&model)?),
        _ => (entity_tag(sha256), json_body(version.head, key.1.clone(), &model)?),
    };
    let answer = CachedAnswer {
        etag: HeaderValue::try_from(etag).map_err(Problem::internal)?,
        body: Bytes::from(body),
    };
    app.champion_cache().insert_answer(key, answer.clone());
    Ok(answer)
}

/// Returns the reason for which a ship has no champion.
async fn no_champion(app: &App, ship: &str) -> Problem {
    if let Err(error) = app.store().ships().get(ship).await {
        return error.into();
    }
    let todo = "upload trials to /v1/trials and POST a refinement to /v1/refinements";
    Problem::not_found(format!("the ship `{ship}` has only particulars and no model yet; {todo}"))
}

fn yaml_body(model: &Model) -> Result<String> {
    serde_yaml::to_string(model).map_err(Problem::internal)
}

fn json_body(
    head: sistership_store::VersionHead,
    report: Option<String>,
    model: &Model,
) -> Result<String> {
    let ship = head.model.clone();
    let version = VersionHead { report, ..VersionHead::from_head(head) };
    let model = serde_json::to_value(model).map_err(Problem::internal)?;
    serde_json::to_string(&Champion { ship, version, model }).map_err(Problem::internal)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn yaml_reads_back_as_the_same_model() {
        let zoo = Zoo::load_embedded().unwrap();
        for vessel in zoo.vessels().filter(|vessel| !vessel.file.models.is_empty()) {
            let model = zoo.published_model(vessel, None).unwrap();
            let law_of = |name: &str| zoo.law(name).map(|law| (**law).clone());
            assert_eq!(
                Model::parse("model.yaml", &yaml_body(&model).unwrap(), &law_of).unwrap(),
                model
            );
        }
    }
}
