//! Trials that a request names, each of which must be one of the ship's.

use axum::http::StatusCode;

use super::trials::bounded;
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::rights::readable_trial;
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
    Ok(match readable_trial(app.store(), id).await? {
        Some(trial) if trial.ship == ship => None,
        Some(trial) => Some(format!("is a trial of `{}`, not of `{ship}`", trial.ship)),
        None => Some(format!("is not there; GET /v1/trials?ship={ship} lists its trials")),
    })
}

/// The refusal of work on a ship that has none.
pub(super) fn no_trials(ship: &str) -> Problem {
    Problem::invalid(
        "trials",
        format!("the ship `{ship}` has no trials; upload some with POST /v1/trials"),
    )
}
