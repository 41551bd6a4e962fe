//! Simulations with a version.

use axum::Json;
use axum::extract::State;
use serde_json::{Value, json};
use sistership_jobs::predictions::{PredictionRequest, predict};
use sistership_model::Model;
use sistership_model::branch::CorrectionDocument;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::model_ref::resolve_version;
use crate::app::App;
use crate::problem::Result;
use crate::web::DocumentBody;

pub(super) fn prediction_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(create))
}

/// Simulate a manoeuvre, recorded inputs, or future orders, with a version of a model
#[utoipa::path(
    post, path = "/v1/predictions", tag = "predictions", request_body = PredictionRequest,
    responses((status = 200, body = Object, description = "`model`, `version`, `sha256`, `law`; \
                                                           `trajectory` under canonical names; \
                                                           `metrics`; `stopped` if the recorded \
                                                           inputs led out of the physical range; \
                                                           for all standard manoeuvres `turns`, \
                                                           `zigzags`, `imo` and, if requested, \
                                                           `bands`; `outside` if the motion left \
                                                           the range covered by the model's \
                                                           trials; over a horizon `foundation`, \
                                                           the track without the learned \
                                                           correction, and, if draws were \
                                                           requested, `band` with `low` and \
                                                           `high` of each state; for a version \
                                                           with a learned correction `branch`, \
                                                           its kind and mode, and `branch_share`, \
                                                           its share in the simulation, 0 to 1"))
)]
async fn create(State(app): State<App>, payload: DocumentBody) -> Result<Json<Value>> {
    let request: PredictionRequest = payload.parse_json()?;
    let version = resolve_version(app.store(), "model", &request.model).await?;
    let model: Model = app.archive().model_with_weights(&version).await?;
    let law = app.stored_law(&model.law).await?;
    let most = app.limits().prediction_samples;
    let branch = model.branch.as_ref().map(branch_description);
    let mut answer = app.run_blocking(move || predict(&request, &model, &law, most)).await??;
    let head = version.head;
    answer["model"] = json!(head.model);
    answer["version"] = json!(head.number);
    answer["sha256"] = json!(head.sha256);
    answer["law"] = json!(head.law);
    if let Some(branch) = branch {
        answer["branch"] = branch;
    }
    Ok(Json(answer))
}

fn branch_description(branch: &CorrectionDocument) -> Value {
    json!({ "kind": branch.recipe.learner.name(), "mode": branch.mode.name() })
}
