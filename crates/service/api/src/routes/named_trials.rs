//! Trials that a request names, each of which must be one of the ship's.

use axum::http::StatusCode;
use sistership_store::StoreError;

use super::trials::bounded;
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::web::Id;

/// The trials of these ids, checked.
pub(super) async fn named(
    app: &App,
    ship: &str,
    ids: Vec<Id>,
    left_out: &str,
) -> Result<Vec<String>> {
    bounded(app, ids.len())?;
    if ids.is_empty() {
        return Err(Problem::invalid(
            "trials",
            format!("is empty; name at least one, or leave it out for {left_out}"),
        ));
    }
    for (index, id) in ids.iter().enumerate() {
        let wrong = if ids[..index].contains(id) {
            Some("is named twice".to_owned())
        } else {
            mismatch(app, ship, id).await?
        };
        if let Some(message) = wrong {
            let problem = Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                format!("trials[{index}]: `{id}` {message}"),
            );
            return Err(problem.with(Fault::at(format!("trials[{index}]"), message)));
        }
    }
    Ok(ids.into_iter().map(Id::into_string).collect())
}

/// Why a trial cannot be one of the ship's.
async fn mismatch(app: &App, ship: &str, id: &str) -> Result<Option<String>> {
    match app.store().trials().get(id).await {
        Ok(trial) if trial.ship == ship => Ok(None),
        Ok(trial) => Ok(Some(format!("is a trial of `{}`, not of `{ship}`", trial.ship))),
        Err(StoreError::NotFound { .. }) => {
            Ok(Some(format!("is not there; GET /v1/trials?ship={ship} lists its trials")))
        }
        Err(error) => Err(error.into()),
    }
}

/// The refusal of work on a ship that has none.
pub(super) fn no_trials(ship: &str) -> Problem {
    Problem::invalid(
        "trials",
        format!("the ship `{ship}` has no trials; upload some with POST /v1/trials"),
    )
}
