//! Whether somebody may do what a route does.

use axum::extract::RawPathParams;
use axum::http::{Method, StatusCode, Uri};
use sistership_auth::{Rights, Role};
use sistership_jobs::fleet::{BULK, Chunk, LEARN, LearnJob};
use sistership_store::{Job, MAX_LIMIT, Page, Store, StoreError, Trial};

use super::table::{Need, Of, need};
use crate::app::App;
use crate::problem::{Problem, Result};
use sistership_web_support::acting::{Acting, current};

/// A request as far as rights depend on it.
pub(crate) struct Asked<'a> {
    pub method: &'a Method,
    pub uri: &'a Uri,
    /// The route, with names in braces; none where there is none.
    pub route: Option<&'a str>,
    pub params: &'a RawPathParams,
}

impl Asked<'_> {
    fn param(&self, name: &str) -> Option<&str> {
        self.params.iter().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    fn query(&self, name: &str) -> Option<String> {
        let pairs = axum::extract::Query::<Vec<(String, String)>>::try_from_uri(self.uri).ok()?;
        pairs.0.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}

/// Whether whoever asks may have the route carried out.
///
/// # Errors
/// They may not; says which role it takes.
pub(crate) async fn allowed(app: &App, acting: &Acting, asked: &Asked<'_>) -> Result<()> {
    // There is nothing to guard where there is no route.
    let Some(route) = asked.route else { return Ok(()) };
    let Some(Need { role, of }) = need(asked.method, route) else { return Ok(()) };
    let Some(role) = role else { return Ok(()) };
    let rights = &acting.principal.rights;
    if rights.on_server(role) {
        return Ok(());
    }
    let given = rights.anywhere(role) && by_scope(app, rights, role, of, asked).await?;
    if given { Ok(()) } else { Err(refused(acting, role, of)) }
}

/// Whether a role that is not given for the whole server is given for what is asked about.
async fn by_scope(
    app: &App,
    rights: &Rights,
    role: Role,
    of: Of,
    asked: &Asked<'_>,
) -> Result<bool> {
    let store = app.store();
    let id = asked.param("id").unwrap_or_default();
    let ship = match of {
        Of::Server => None,
        // What it is about is found in the body, by whoever reads it.
        Of::Anything | Of::Body => return Ok(true),
        Of::Ship(name) => asked.param(name).map(str::to_owned),
        Of::ShipOfQuery => asked.query("ship"),
        Of::Job => match store.jobs().get(id).await? {
            Job { ship: None, kind, request, .. } => {
                let family = family_of_job(store, &kind, &request).await?;
                return Ok(family.is_some_and(|family| rights.on_family(role, &family)));
            }
            Job { ship, .. } => ship,
        },
        Of::Trial => Some(store.trials().get(id).await?.ship),
        Of::Report => Some(store.reports().get(id).await?.head.ship),
        Of::Family => {
            return Ok(asked.param("family").is_some_and(|name| rights.on_family(role, name)));
        }
        Of::FamilyOfQuery => {
            return Ok(asked.query("family").is_some_and(|name| rights.on_family(role, &name)));
        }
        Of::Bulk => return Ok(rights.on_family(role, &store.bulks().get(id).await?.family)),
    };
    match ship {
        Some(ship) => has(store, rights, role, &ship).await,
        None => Ok(false),
    }
}

/// The family of a job that is of no ship.
async fn family_of_job(store: &Store, kind: &str, request: &str) -> Result<Option<String>> {
    Ok(match kind {
        LEARN => serde_json::from_str::<LearnJob>(request).ok().map(|job| job.family),
        BULK => match serde_json::from_str::<Chunk>(request) {
            Ok(chunk) => Some(store.bulks().get(&chunk.bulk).await?.family),
            Err(_) => None,
        },
        _ => None,
    })
}

/// Whether a role is given for a ship, by its name or its families.
async fn has(store: &Store, rights: &Rights, role: Role, ship: &str) -> Result<bool> {
    let mut families = Vec::new();
    if rights.by_family() {
        let found = store.families().of_ship(ship, &Page::first(MAX_LIMIT)).await?;
        families.extend(found.items.into_iter().map(|family| family.name));
    }
    Ok(rights.on_ship(role, ship, &families))
}

/// Whether whoever the present request is carried out for has a role for a ship that only its body
/// names.
///
/// # Errors
/// They have not, or nobody asks.
pub(crate) async fn on_ship(store: &Store, role: Role, ship: &str) -> Result<()> {
    let acting = current().ok_or_else(|| Problem::internal("nobody is named who asks"))?;
    let rights = &acting.principal.rights;
    match rights.on_server(role) || has(store, rights, role, ship).await? {
        true => Ok(()),
        false => Err(refused(&acting, role, Of::Ship("ship"))),
    }
}

/// Those of some things that are of ships for which whoever asks has a role.
///
/// # Errors
/// The store does not answer, or nobody asks.
pub(crate) async fn visible<T>(
    store: &Store,
    role: Role,
    all: Vec<T>,
    ship: impl Fn(&T) -> &str,
) -> Result<Vec<T>> {
    let acting = current().ok_or_else(|| Problem::internal("nobody is named who asks"))?;
    let rights = &acting.principal.rights;
    if rights.on_server(role) {
        return Ok(all);
    }
    let mut kept = Vec::new();
    for one in all {
        if has(store, rights, role, ship(&one)).await? {
            kept.push(one);
        }
    }
    Ok(kept)
}

/// A trial that a query or a body names, for whoever has a role for its ship. To others one of
/// another ship is not there.
///
/// # Errors
/// The store does not answer.
pub(crate) async fn readable_trial(store: &Store, id: &str) -> Result<Option<Trial>> {
    let trial = match store.trials().get(id).await {
        Err(StoreError::NotFound { .. }) => return Ok(None),
        trial => trial?,
    };
    let mut kept = visible(store, Role::Reader, vec![trial], |trial| &trial.ship).await?;
    Ok(kept.pop())
}

fn refused(acting: &Acting, role: Role, of: Of) -> Problem {
    let name = &acting.principal.name;
    let roles: Vec<String> =
        acting.principal.rights.grants().iter().map(ToString::to_string).collect();
    let has = if roles.is_empty() { "no role".to_owned() } else { roles.join(", ") };
    let whom = of.words();
    Problem::new(
        StatusCode::FORBIDDEN,
        format!("this needs the role {role} for {whom}; `{name}` has {has}. An admin can give it"),
    )
}
