//! Decision whether a caller may use a route.

use axum::extract::RawPathParams;
use axum::http::{Method, StatusCode, Uri};
use sistership_auth::{Rights, Role};
use sistership_jobs::fleet::{BULK_JOB_KIND, BulkChunk, LearnJob, PRIOR_JOB_KIND};
use sistership_store::{Job, Store, StoreError, Trial, read_all_pages};

use super::table::{RoleScope, RouteNeed, route_need};
use crate::app::App;
use crate::problem::{Problem, Result};
use sistership_web_support::acting::{RequestActor, current_actor};

/// Parts of a request on which rights depend.
pub(crate) struct RightsRequest<'a> {
    pub method: &'a Method,
    pub uri: &'a Uri,
    /// The route, with names in braces; `None` if there is none.
    pub route: Option<&'a str>,
    pub params: &'a RawPathParams,
}

impl RightsRequest<'_> {
    fn path_param(&self, name: &str) -> Option<&str> {
        self.params.iter().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    fn query_param(&self, name: &str) -> Option<String> {
        let pairs = axum::extract::Query::<Vec<(String, String)>>::try_from_uri(self.uri).ok()?;
        pairs.0.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}

/// Checks that the caller may use the route.
///
/// # Errors
/// Returns 403 with the role that is needed.
pub(crate) async fn check_access(
    app: &App,
    acting: &RequestActor,
    asked: &RightsRequest<'_>,
) -> Result<()> {
    // There is nothing to guard where there is no route.
    let Some(route) = asked.route else { return Ok(()) };
    let Some(RouteNeed { role, of }) = route_need(asked.method, route) else { return Ok(()) };
    let Some(role) = role else { return Ok(()) };
    let rights = &acting.principal.rights;
    if rights.on_server(role) {
        return Ok(());
    }
    // The scope may take a look-up in the store, so that callers without the role anywhere are
    // refused first.
    let given =
        rights.holds_anywhere(role) && has_scoped_role(app, rights, role, of, asked).await?;
    if given { Ok(()) } else { Err(access_denied(acting, role, of)) }
}

/// Returns true if a role that is not given for the whole server is given for the object of the
/// request.
async fn has_scoped_role(
    app: &App,
    rights: &Rights,
    role: Role,
    of: RoleScope,
    asked: &RightsRequest<'_>,
) -> Result<bool> {
    let store = app.store();
    let id = asked.path_param("id").unwrap_or_default();
    let ship = match of {
        RoleScope::Server => None,
        // The handler finds the ship in the body, and checks the role there.
        RoleScope::Anything | RoleScope::Body => return Ok(true),
        RoleScope::Ship(name) => asked.path_param(name).map(str::to_owned),
        RoleScope::ShipOfQuery => asked.query_param("ship"),
        RoleScope::Job => match store.jobs().get(id).await? {
            Job { ship: None, kind, request, .. } => {
                let family = family_of_job(store, &kind, &request).await?;
                return Ok(family.is_some_and(|family| rights.on_family(role, &family)));
            }
            Job { ship, .. } => ship,
        },
        RoleScope::Trial => Some(store.trials().get(id).await?.ship),
        RoleScope::Report => Some(store.reports().get(id).await?.head.ship),
        RoleScope::Family => {
            return Ok(asked.path_param("family").is_some_and(|name| rights.on_family(role, name)));
        }
        RoleScope::FamilyOfQuery => {
            return Ok(asked
                .query_param("family")
                .is_some_and(|name| rights.on_family(role, &name)));
        }
        RoleScope::Bulk => return Ok(rights.on_family(role, &store.bulks().get(id).await?.family)),
    };
    match ship {
        Some(ship) => has_role(store, rights, role, &ship).await,
        None => Ok(false),
    }
}

/// Returns the family of a job that belongs to no ship.
async fn family_of_job(store: &Store, kind: &str, request: &str) -> Result<Option<String>> {
    Ok(match kind {
        PRIOR_JOB_KIND => serde_json::from_str::<LearnJob>(request).ok().map(|job| job.family),
        BULK_JOB_KIND => match serde_json::from_str::<BulkChunk>(request) {
            Ok(chunk) => Some(store.bulks().get(&chunk.bulk).await?.family),
            Err(_) => None,
        },
        _ => None,
    })
}

/// Returns true if a role is given for a ship, by its name or its families.
async fn has_role(store: &Store, rights: &Rights, role: Role, ship: &str) -> Result<bool> {
    let mut families = Vec::new();
    // Families are read only if the caller has rights by family at all.
    if rights.by_family() {
        let rows = store.families();
        let found =
            read_all_pages(|page| async move { rows.list_by_ship(ship, &page).await }).await?;
        families.extend(found.into_iter().map(|family| family.name));
    }
    Ok(rights.on_ship(role, ship, &families))
}

/// Checks that the current caller has a role for a ship that only the body of the request names.
///
/// # Errors
/// Returns 403 if the role is missing, and an internal error without a caller.
pub(crate) async fn check_ship_role(store: &Store, role: Role, ship: &str) -> Result<()> {
    let acting = current_actor().ok_or_else(|| {
        Problem::internal("the request has no user or key; sign in, or send a key")
    })?;
    let rights = &acting.principal.rights;
    match rights.on_server(role) || has_role(store, rights, role, ship).await? {
        true => Ok(()),
        false => Err(access_denied(&acting, role, RoleScope::Ship("ship"))),
    }
}

/// Checks that the current caller has a role for the whole server.
///
/// # Errors
/// Returns 403 if the role is missing, and an internal error without a caller.
pub(crate) fn check_server_role(role: Role) -> Result<()> {
    let acting = current_actor().ok_or_else(|| {
        Problem::internal("the request has no user or key; sign in, or send a key")
    })?;
    match acting.principal.rights.on_server(role) {
        true => Ok(()),
        false => Err(access_denied(&acting, role, RoleScope::Server)),
    }
}

/// Returns those items that belong to ships for which the caller has a role.
///
/// # Errors
/// Returns an error if the store fails, and an internal error without a caller.
pub(crate) async fn filter_visible<T>(
    store: &Store,
    role: Role,
    all: Vec<T>,
    ship: impl Fn(&T) -> &str,
) -> Result<Vec<T>> {
    let acting = current_actor().ok_or_else(|| {
        Problem::internal("the request has no user or key; sign in, or send a key")
    })?;
    let rights = &acting.principal.rights;
    if rights.on_server(role) {
        return Ok(all);
    }
    let mut kept = Vec::new();
    for one in all {
        if has_role(store, rights, role, ship(&one)).await? {
            kept.push(one);
        }
    }
    Ok(kept)
}

/// Returns a trial that a query or a body names, if the caller has a role for its ship. For other
/// callers the trial does not exist.
///
/// # Errors
/// Returns an error if the store fails.
pub(crate) async fn readable_trial(store: &Store, id: &str) -> Result<Option<Trial>> {
    let trial = match store.trials().get(id).await {
        Err(StoreError::NotFound { .. }) => return Ok(None),
        trial => trial?,
    };
    let mut kept = filter_visible(store, Role::Reader, vec![trial], |trial| &trial.ship).await?;
    Ok(kept.pop())
}

fn access_denied(acting: &RequestActor, role: Role, of: RoleScope) -> Problem {
    let name = &acting.principal.name;
    let roles: Vec<String> =
        acting.principal.rights.grants().iter().map(ToString::to_string).collect();
    let has = if roles.is_empty() { "no role".to_owned() } else { roles.join(", ") };
    let whom = of.description();
    Problem::new(
        StatusCode::FORBIDDEN,
        format!("this needs the role {role} for {whom}; `{name}` has {has}. An admin can grant it"),
    )
}
