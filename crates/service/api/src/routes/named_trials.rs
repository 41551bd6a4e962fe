//! Trials that a request names, each of which must belong to the ship.

use axum::http::StatusCode;

use super::trials::check_trial_count;
use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use crate::rights::readable_trial;
use crate::web::Id;

/// Checks the ids of trials; `left_out` says what applies if the field is omitted.
///
/// # Errors
/// Returns an error that names the first id that is repeated, unknown, or of another ship.
pub(super) async fn checked_trials(
    app: &App,
    ship: &str,
    ids: Vec<Id>,
    left_out: &str,
) -> Result<Vec<String>> {
    check_trial_count(app, ids.len())?;
    if ids.is_empty() {
        return Err(Problem::invalid(
            "trials",
            format!("is empty; give at least one trial, or omit it for {left_out}"),
        ));
    }
    for (index, id) in ids.iter().enumerate() {
        let wrong = if ids[..index].contains(id) {
            Some("is listed twice".to_owned())
        } else {
            mismatch_message(app, ship, id).await?
        };
        if let Some(message) = wrong {
            let problem = Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                format!("trials[{index}]: `{id}` {message}"),
            );
            return Err(problem.with_fault(Fault::at_field(format!("trials[{index}]"), message)));
        }
    }
    Ok(ids.into_iter().map(Id::into_string).collect())
}

/// Returns the reason for which a trial cannot be one of the ship's.
async fn mismatch_message(app: &App, ship: &str, id: &str) -> Result<Option<String>> {
    Ok(match readable_trial(app.store(), id).await? {
        Some(trial) if trial.ship == ship => None,
        Some(trial) => Some(format!("is a trial of `{}`, not of `{ship}`", trial.ship)),
        None => Some(format!(
            "does not exist; GET /v1/trials?ship={ship} lists the trials of the \
                              ship"
        )),
    })
}

/// Refusal of work on a ship without trials.
pub(super) fn no_trials(ship: &str) -> Problem {
    Problem::invalid(
        "trials",
        format!("the ship `{ship}` has no trials; upload some with POST /v1/trials"),
    )
}
