//! Comparison of versions.

use axum::Json;
use axum::extract::State;
use sistership_jobs::comparison::stored::{Asked, compared, demand};
use sistership_jobs::comparison::{BETWEEN, Comparison, MOST_TRIALS};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::model_ref::resolve;
use crate::app::App;
use crate::problem::{Problem, Result};
use crate::rights::readable_trial;
use crate::web::{Id, ModelName, Params};
use sistership_web_support::ship_search::wrong;

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(compare))
}

#[derive(Debug, IntoParams)]
#[into_params(parameter_in = Query)]
#[allow(dead_code, reason = "it only describes the query, whose parameters come several times")]
struct Query {
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
#[utoipa::path(get, path = "/v1/compare", tag = "models", params(Query),
    responses((status = 200, body = Comparison)))]
async fn compare(
    State(app): State<App>,
    Params(pairs): Params<Vec<(String, String)>>,
) -> Result<Json<Comparison>> {
    let ids = read::<Id>(&pairs, "trial", [0, MOST_TRIALS])?;
    let names = read::<ModelName>(&pairs, "version", BETWEEN)?;
    let mut asked = Asked::default();
    for name in &names {
        let version = resolve(app.store(), "version", name).await?;
        let law = app.law(&version.head.law).await?;
        asked.versions.push((name.clone(), app.archive().model(&version).await?, law));
    }
    for id in &ids {
        let missing = || Problem::invalid("trial", format!("there is no trial `{id}`"));
        let trial = readable_trial(app.store(), id).await?;
        asked.trials.push(trial.ok_or_else(missing)?);
    }
    // Simulations of several versions take as much memory as a job.
    let _share = app.job_memory().take(demand(&asked), app.limits().memory_wait).await?;
    let samples = app.archive().trials(&asked.samples()).await?;
    let done = app.compute(move || compared(&asked, &samples)).await?;
    done.map(Json).map_err(|error| Problem::invalid("version", error.to_string()))
}

/// Returns the values of a repeated parameter.
///
/// # Errors
/// Returns an error if a value is invalid, or if there are too few or too many.
fn read<T: std::str::FromStr<Err = String>>(
    pairs: &[(String, String)],
    field: &str,
    [least, most]: [usize; 2],
) -> Result<Vec<String>> {
    let wrong = |message: String| wrong(field, message);
    let given = pairs.iter().filter(|(name, _)| name == field);
    let one = |value: &String| value.parse::<T>().map(|_| value.clone()).map_err(wrong);
    let values = given.map(|(_, value)| one(value)).collect::<Result<Vec<String>>>()?;
    if !(least..=most).contains(&values.len()) {
        let count = values.len();
        return Err(wrong(format!("there is no comparison of {count}; give {least} to {most}")));
    }
    Ok(values)
}
