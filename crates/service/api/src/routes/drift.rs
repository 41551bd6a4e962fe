//! Ships whose model no longer agrees with new trials.

use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::MemberLimit;
use crate::web::{Name, PathParams, QueryParams, Word};
use sistership_jobs::fleet::{Drift, FamilyDrift};

pub(super) fn drift_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(of_ship)).routes(routes!(of_family))
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct DriftQuery {
    /// Number of members to examine; those whose diagnosis says that their model does not hold come
    /// first.
    #[param(inline)]
    limit: Option<MemberLimit>,
}

/// Get the unexplained force of a ship's champion in each of its trials, over time
#[utoipa::path(
    get, path = "/v1/ships/{ship}/drift", tag = "ships", params(("ship" = inline(Name), Path)),
    responses((status = 200, body = Drift))
)]
async fn of_ship(
    State(app): State<App>,
    PathParams(ship): PathParams<Name>,
) -> Result<Json<Drift>> {
    app.store().ships().get(&ship).await?;
    let drift = Drift::for_champion(app.archive(), &ship).await?;
    drift.map(Json).ok_or_else(|| {
        Problem::invalid(
            "ship",
            format!("`{ship}` has no champion yet; refine a model for it first"),
        )
    })
}

/// List the ships of a family whose model no longer holds, the worst first, with the effects that
/// their diagnosis names
#[utoipa::path(
    get, path = "/v1/families/{family}/drift", tag = "families",
    params(("family" = inline(Word), Path), DriftQuery),
    responses((status = 200, body = FamilyDrift))
)]
async fn of_family(
    State(app): State<App>,
    PathParams(name): PathParams<Word>,
    QueryParams(query): QueryParams<DriftQuery>,
) -> Result<Json<FamilyDrift>> {
    let limit = query.limit.unwrap_or_default().get();
    Ok(Json(FamilyDrift::read_members(app.archive(), &name, limit).await?))
}
