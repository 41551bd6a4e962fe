//! Ranking of similar ships.

use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use serde_json::Value;
use sistership_model::version::RecipeTrial;
use sistership_priors::similarity::VectorDefinition;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::trials::all_of_ship;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::filter_visible;
use crate::web::{Name, PathParams, QueryParams};
use sistership_auth::Role;
use sistership_jobs::archive::parse_vessel;
use sistership_jobs::budget;
use sistership_jobs::champions::SourceModels;
use sistership_jobs::memory::trial_bytes;
use sistership_web_support::ship_search::vectors;

pub(super) fn similarity_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(similar))
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct SimilarQuery {
    /// `mei-2019` or `kanazawa-2023`; by default Mei's if the ship has every component of it,
    /// otherwise Kanazawa's.
    #[param(schema_with = vectors)]
    vector: Option<VectorDefinition>,
    /// True if eligible ships are evaluated on the trials of the ship, if it has any.
    #[serde(default = "yes")]
    trials: bool,
}

fn yes() -> bool {
    true
}

/// Rank the zoo by similarity to a ship, with the eligible source models
///
/// The ships are those for which you have a role. Of a zoo of more than 250 ships only the 250 of
/// its category that are most similar to it are ranked; `GET /v1/ships?similar_to=` has all of
/// them.
#[utoipa::path(
    get, path = "/v1/ships/{ship}/similar", tag = "ships",
    params(("ship" = inline(Name), Path), SimilarQuery),
    responses((status = 200, body = Object, description = "`target`, `definition`, `vector` and \
        `ranking`, as `sistership similar --json`"))
)]
async fn similar(
    State(app): State<App>,
    PathParams(name): PathParams<Name>,
    QueryParams(query): QueryParams<SimilarQuery>,
) -> Result<Json<Value>> {
    let ship = app.store().ships().get(&name).await?;
    let target = parse_vessel(&ship.name, &ship.document)?;
    let trials = if query.trials { all_of_ship(&app, &name).await? } else { Vec::new() };
    budget::reserve_for_request(trials.iter().map(|trial| trial_bytes(trial.sample_rows)).sum())
        .await?;
    let named =
        trials.into_iter().map(|trial| RecipeTrial { name: trial.name, sha256: trial.object_key });
    let trials = app.archive().read_trials(&named.collect::<Vec<_>>()).await?;
    let zoo = app.zoo_around(&target).await?;
    let models = SourceModels::for_zoo(app.archive(), &zoo).await?;
    let ranked = move || {
        models.rank_sources(&zoo, &target, query.vector, &trials.iter().collect::<Vec<_>>())
    };
    let mut ranked = app.run_blocking(ranked).await?;
    // Filtered after the ranking, so that the correlations do not depend on the caller.
    ranked.ranking =
        filter_visible(app.store(), Role::Reader, ranked.ranking, |ranked| &ranked.ship).await?;
    Ok(Json(serde_json::to_value(ranked).map_err(Problem::internal)?))
}
