//! Ships whose model no longer holds.

use axum::Json;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use sistership_store::Page;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::{Problem, Result};
use crate::web::field::MemberLimit;
use crate::web::{Name, Params, Place, Word};
use sistership_pipeline::condition::Condition;
use sistership_pipeline::fleet::Drift;

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(of_ship)).routes(routes!(of_family))
}

#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
struct Query {
    /// How many members are looked at; those whose diagnosis says that their model does not hold
    /// come first.
    #[param(inline)]
    limit: Option<MemberLimit>,
}

/// The members of a family, the one whose model holds least first.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct FamilyDrift {
    pub family: String,
    /// How many members it has.
    pub members: i64,
    /// Those that were looked at.
    pub ships: Vec<MemberDrift>,
}

/// How the model of a member holds.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct MemberDrift {
    pub ship: String,
    /// What the newest diagnosis of her champion found: the effects that it lacks.
    pub condition: Condition,
    /// What her champion leaves of her trials over time.
    pub drift: Option<Drift>,
}

/// What a ship's champion leaves of each of her trials, over time
#[utoipa::path(
    get, path = "/v1/ships/{ship}/drift", tag = "ships", params(("ship" = inline(Name), Path)), responses((status = 200, body = Drift))
)]
async fn of_ship(State(app): State<App>, Place(ship): Place<Name>) -> Result<Json<Drift>> {
    app.store().ships().get(&ship).await?;
    let drift = Drift::of(app.archive(), &ship).await?;
    drift.map(Json).ok_or_else(|| {
        Problem::invalid(
            "ship",
            format!("`{ship}` has no champion yet; refine a model for her first"),
        )
    })
}

/// Ships of a family whose model no longer holds, the worst first, with the effects that their
/// diagnosis names
#[utoipa::path(
    get, path = "/v1/families/{family}/drift", tag = "families", params(("family" = inline(Word), Path), Query),
    responses((status = 200, body = FamilyDrift))
)]
async fn of_family(
    State(app): State<App>,
    Place(name): Place<Word>,
    Params(query): Params<Query>,
) -> Result<Json<FamilyDrift>> {
    let limit = query.limit.unwrap_or_default().get();
    Ok(Json(FamilyDrift::of(&app, &name, limit).await?))
}

impl FamilyDrift {
    /// Of the members whose diagnosis says that they do not hold, and of the first others up to
    /// `limit`.
    pub(super) async fn of(app: &App, name: &str, limit: i64) -> Result<Self> {
        let families = app.store().families();
        let family = families.get(name).await?;
        let drifted = families.drifted(&family.name, limit).await?;
        let others = families.members(&family.name, &Page::first(limit)).await?.items;
        let known: std::collections::BTreeSet<String> =
            drifted.iter().map(|member| member.ship.clone()).collect();
        let others = others.into_iter().filter(|member| !known.contains(&member.ship));
        let mut ships = Vec::new();
        for member in drifted.into_iter().chain(others).take(usize::try_from(limit).unwrap_or(0)) {
            let condition = Condition::of(app.store(), &member.ship).await?;
            let drift = Drift::of(app.archive(), &member.ship).await?;
            ships.push(MemberDrift { ship: member.ship, condition, drift });
        }
        ships.sort_by(|a, b| {
            b.worse().0.cmp(&a.worse().0).then(b.worse().1.total_cmp(&a.worse().1))
        });
        Ok(Self { members: families.count(&family.name).await?, family: family.name, ships })
    }
}

impl MemberDrift {
    /// Whether the diagnosis says that her model does not hold, and how much more it leaves of what
    /// is new.
    fn worse(&self) -> (bool, f64) {
        let worst = self.drift.as_ref().and_then(|drift| drift.worst);
        (
            self.condition.model == sistership_pipeline::condition::Standing::DoesNotHold,
            worst.unwrap_or(0.0),
        )
    }
}
