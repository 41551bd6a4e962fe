//! Comparison of versions.

use axum::Json;
use axum::extract::State;
use sistership_jobs::comparison::stored::{ComparisonInputs, compare_stored, memory_demand};
use sistership_jobs::comparison::{Comparison, MODEL_COUNT_LIMITS, MOST_TRIALS};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::model_ref::resolve_version;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::readable_trial;
use crate::web::{Id, ModelName, QueryParams};
use sistership_web_support::ship_search::parameter_problem;

pub(super) fn comparison_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(compare))
}

#[derive(Debug, IntoParams)]
#[into_params(parameter_in = Query)]
#[allow(dead_code, reason = "describes the query only; its parameters may be repeated")]
struct CompareQuery {
    /// Two to five versions: `ship` (its champion), `ship/number` or `ship/alias`.
    #[param(inline, style = Form, explode, min_items = 2, max_items = 5)]
    version: Vec<ModelName>,
    /// Trials on which each of them is simulated.
    #[param(inline, style = Form, explode, max_items = 20)]
    trial: Option<Vec<Id>>,
}

/// Compare two to five versions
///
/// Coefficients with their standard errors, errors on the same trials, each simulated once from its
/// first sample, figures of the standard manoeuvres, and the IMO criteria.
#[utoipa::path(get, path = "/v1/compare", tag = "models", params(CompareQuery),
    responses((status = 200, body = Comparison)))]
async fn compare(
    State(app): State<App>,
    QueryParams(pairs): QueryParams<Vec<(String, String)>>,
) -> Result<Json<Comparison>> {
    let ids = repeated_values::<Id>(&pairs, "trial", [0, MOST_TRIALS])?;
    let names = repeated_values::<ModelName>(&pairs, "version", MODEL_COUNT_LIMITS)?;
    let mut asked = ComparisonInputs::default();
    for name in &names {
        let version = resolve_version(app.store(), "version", name).await?;
        let law = app.stored_law(&version.head.law).await?;
        asked.versions.push((name.clone(), app.archive().model_with_weights(&version).await?, law));
    }
    for id in &ids {
        let missing = || Problem::invalid("trial", format!("there is no trial `{id}`"));
        let trial = readable_trial(app.store(), id).await?;
        asked.trials.push(trial.ok_or_else(missing)?);
    }
    // Simulations of several versions take as much memory as a job.
    let _share = app.job_memory().reserve(memory_demand(&asked), app.limits().memory_wait).await?;
    let samples = app.archive().read_trials(&asked.recipe_trials()).await?;
    let done = app.run_blocking(move || compare_stored(&asked, &samples)).await?;
    done.map(Json).map_err(|error| Problem::invalid("version", error.to_string()))
}

/// Returns the values of a repeated parameter.
///
/// # Errors
/// Returns an error if a value is invalid, or if there are too few or too many.
fn repeated_values<T: std::str::FromStr<Err = String>>(
    pairs: &[(String, String)],
    field: &str,
    [least, most]: [usize; 2],
) -> Result<Vec<String>> {
    let wrong = |message: String| parameter_problem(field, message);
    let given = pairs.iter().filter(|(name, _)| name == field);
    let one = |value: &String| value.parse::<T>().map(|_| value.clone()).map_err(wrong);
    let values = given.map(|(_, value)| one(value)).collect::<Result<Vec<String>>>()?;
    if !(least..=most).contains(&values.len()) {
        let count = values.len();
        return Err(wrong(format!("{count} versions cannot be compared; give {least} to {most}")));
    }
    Ok(values)
}
