//! Resolution of version names: `ship`, `ship/number`, `ship/alias`.

use sistership_store::{Store, StoreError, Version};

use crate::problem::{Problem, Result};
use crate::rights::check_ship_role;
use sistership_auth::Role;
use sistership_jobs::aliases::{CHAMPION, find_alias};

/// Returns the version that a name in a request refers to; `field` is named in errors.
pub(super) async fn resolve_version(store: &Store, field: &str, name: &str) -> Result<Version> {
    let (ship, rest) = name.split_once('/').unwrap_or((name, CHAMPION));
    check_ship_role(store, Role::Reader, ship).await?;
    let number = match rest.parse() {
        Ok(number) => number,
        Err(_) => {
            find_alias(store, ship, rest)
                .await?
                .ok_or_else(|| unknown_model(field, name))?
                .version_number
        }
    };
    match store.versions().get(ship, number).await {
        Err(StoreError::NotFound { .. }) => Err(unknown_model(field, name)),
        other => Ok(other?),
    }
}

fn unknown_model(field: &str, name: &str) -> Problem {
    let forms = "give `ship` (its champion), `ship/number` or `ship/alias`";
    Problem::invalid(
        field,
        format!(
            "there is no model `{name}`; {forms}; GET /v1/ships lists the ships, \
             /v1/models/SHIP/versions their versions"
        ),
    )
}
