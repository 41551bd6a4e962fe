//! Conditions of trials as people state them: date, place, weather, loading, instruments.

use axum::Json;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;
use crate::problem::Result;
use crate::web::field::{CalendarDate, ConditionText, Draught};
use crate::web::{DocumentBody, Id, PathParams};

pub(super) fn condition_routes() -> OpenApiRouter<App> {
    OpenApiRouter::new().routes(routes!(get, state))
}

/// Conditions of a trial to be stated; what is left out is not known.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct ConditionsRequest {
    /// Date of the trial.
    #[schema(inline)]
    date: Option<CalendarDate>,
    /// Place, such as `Skagerrak, 57.9 N 9.8 E`.
    #[schema(inline)]
    place: Option<ConditionText>,
    /// Wind, such as `6 m/s from south-west`.
    #[schema(inline)]
    wind: Option<ConditionText>,
    /// Sea and swell.
    #[schema(inline)]
    sea: Option<ConditionText>,
    /// Water depth, such as `180 m` or `deep`.
    #[schema(inline)]
    depth: Option<ConditionText>,
    /// Draught fore, m.
    #[schema(inline)]
    draught_fore_m: Option<Draught>,
    /// Draught aft, m.
    #[schema(inline)]
    draught_aft_m: Option<Draught>,
    /// Displacement during the trial, such as `21 800 t`.
    #[schema(inline)]
    displacement: Option<ConditionText>,
    /// Instruments.
    #[schema(inline)]
    instruments: Option<ConditionText>,
    /// Remarks.
    #[schema(inline)]
    remarks: Option<ConditionText>,
}

impl ConditionsRequest {
    /// Returns the statement as it is stored: texts by name.
    fn into_statement(self) -> Value {
        let words = |text: Option<ConditionText>| text.map(ConditionText::into_string);
        // A statement is evidence: also numbers are kept as they were written.
        let metres = |draught: Option<Draught>| draught.map(|draught| draught.get().to_string());
        let fields = [
            ("date", self.date.map(CalendarDate::into_string)),
            ("place", words(self.place)),
            ("wind", words(self.wind)),
            ("sea", words(self.sea)),
            ("depth", words(self.depth)),
            ("draught_fore_m", metres(self.draught_fore_m)),
            ("draught_aft_m", metres(self.draught_aft_m)),
            ("displacement", words(self.displacement)),
            ("instruments", words(self.instruments)),
            ("remarks", words(self.remarks)),
        ];
        // What was not stated is absent, so that a reader never takes an empty text for a statement.
        let stated = fields.into_iter().filter_map(|(name, text)| Some((name.to_owned(), text?)));
        stated.map(|(name, text)| (name, Value::from(text))).collect::<Map<_, _>>().into()
    }
}

/// Conditions of a trial as they were last stated.
#[derive(Debug, Serialize, ToSchema)]
struct ConditionsView {
    /// Texts by the names of the request; empty if nothing was stated.
    #[schema(value_type = Object)]
    conditions: Value,
}

/// Get the conditions of a trial as they were last stated
#[utoipa::path(
    get, path = "/v1/trials/{id}/conditions", tag = "trials", params(("id" = inline(Id), Path)),
    responses((status = 200, body = ConditionsView))
)]
async fn get(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
) -> Result<Json<ConditionsView>> {
    // A trial that does not exist is an error, not one without conditions.
    app.store().trials().get(&id).await?;
    let stated = app.store().trials().stated_conditions(&id).await?;
    Ok(Json(ConditionsView { conditions: stated.unwrap_or_else(|| Map::new().into()) }))
}

/// State the conditions of a trial; they replace what was stated before
///
/// The acceptance summary of a version prints the conditions of its trials. Statements are part of
/// the audit.
#[utoipa::path(
    put, path = "/v1/trials/{id}/conditions", tag = "trials", params(("id" = inline(Id), Path)),
    request_body = ConditionsRequest, responses((status = 200, body = ConditionsView))
)]
async fn state(
    State(app): State<App>,
    PathParams(id): PathParams<Id>,
    payload: DocumentBody,
) -> Result<Json<ConditionsView>> {
    let asked: ConditionsRequest = payload.parse_json()?;
    // The audit of the ship has the statement, too.
    let ship = app.store().trials().get(&id).await?.ship;
    let conditions = asked.into_statement();
    app.store().trials().state_conditions(&ship, &[id.into_string()], &conditions).await?;
    Ok(Json(ConditionsView { conditions }))
}
