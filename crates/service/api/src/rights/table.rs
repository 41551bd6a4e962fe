//! The role that each route needs, and its scope: the only place that says so. A route that is
//! missing here is for admins; a test checks that none is.

use axum::http::Method;
use sistership_auth::Role;

use Role::{Admin, Approver, Engineer, Reader};

/// Role that a route needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RouteNeed {
    /// The least role; `None` if any identified caller may use the route.
    pub role: Option<Role>,
    /// Object for which the role must be given, if it is not given for the server.
    pub of: RoleScope,
}

/// Object for which a role must be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RoleScope {
    /// The whole server.
    Server,
    /// Any object.
    Anything,
    /// The ship named by this parameter of the path.
    Ship(&'static str),
    /// The ship of the query; the whole server by default.
    ShipOfQuery,
    /// The family of the path.
    Family,
    /// The family of the query; the whole server by default.
    FamilyOfQuery,
    /// The ship of the job, or its family if it has no ship.
    Job,
    /// The ship of the trial.
    Trial,
    /// The ship of the report.
    Report,
    /// The family of the bulk refinement.
    Bulk,
    /// The ship that the body names.
    Body,
}

impl RoleScope {
    /// The object in words.
    pub(crate) fn description(self) -> &'static str {
        match self {
            Self::Server => "the server",
            Self::Anything => "anything",
            Self::Ship(_) | Self::Job | Self::Trial | Self::Report | Self::Body => "the ship",
            Self::ShipOfQuery => "the ship in the query, or the server",
            Self::Family | Self::Bulk => "the family",
            Self::FamilyOfQuery => "the family in the query, or the server",
        }
    }
}

/// Method, route, role and scope.
pub(crate) type RouteRow = (&'static str, &'static str, Role, RoleScope);

/// Routes that need no key, under any host name: their answers hold nothing worth protecting.
pub(crate) const HEALTH_ROUTES: [(&str, &str); 3] =
    [("GET", "/healthz"), ("GET", "/readyz"), ("GET", "/openapi.json")];

/// Routes of signing in.
pub(crate) const OPEN_ROUTES: [(&str, &str); 5] = [
    ("GET", "/sign-in"),
    ("POST", "/sign-in"),
    ("GET", "/sign-in/oidc"),
    ("GET", "/sign-in/oidc/callback"),
    ("POST", "/language"),
];

/// Routes for any identified caller.
pub(crate) const IDENTIFIED_ROUTES: [(&str, &str); 5] = [
    ("GET", "/v1/me"),
    ("GET", "/account"),
    ("POST", "/account/password"),
    ("POST", "/account/identity"),
    ("POST", "/sign-out"),
];

const SHIP: RoleScope = RoleScope::Ship("ship");
const MODEL: RoleScope = RoleScope::Ship("model");

/// All routes but those of the three lists above.
#[rustfmt::skip]
pub(crate) const ROLE_TABLE: &[RouteRow] = &[
    ("GET", "/metrics", Reader, RoleScope::Server),
    // Ships.
    ("GET", "/v1/ships", Reader, RoleScope::Server),
    ("POST", "/v1/ships", Engineer, RoleScope::Server),
    ("GET", "/v1/ships/{ship}", Reader, SHIP),
    ("PUT", "/v1/ships/{ship}", Engineer, SHIP),
    ("DELETE", "/v1/ships/{ship}", Engineer, SHIP),
    ("POST", "/v1/ships/{ship}/undelete", Engineer, SHIP),
    ("GET", "/v1/ships/{ship}/drift", Reader, SHIP),
    ("GET", "/v1/ships/{ship}/model", Reader, SHIP),
    ("GET", "/v1/ships/{ship}/notes", Reader, SHIP),
    ("POST", "/v1/ships/{ship}/notes", Engineer, SHIP),
    ("PUT", "/v1/ships/{ship}/particulars", Engineer, SHIP),
    ("GET", "/v1/ships/{ship}/similar", Reader, SHIP),
    ("GET", "/v1/ships/{ship}/tags", Reader, SHIP),
    ("PUT", "/v1/ships/{ship}/tags/{tag}", Engineer, SHIP),
    ("DELETE", "/v1/ships/{ship}/tags/{tag}", Engineer, SHIP),
    // Trials.
    ("GET", "/v1/trials", Reader, RoleScope::ShipOfQuery),
    ("POST", "/v1/trials", Engineer, RoleScope::Body),
    ("POST", "/v1/trials/check", Reader, RoleScope::Anything),
    ("GET", "/v1/trials/{id}", Reader, RoleScope::Trial),
    ("DELETE", "/v1/trials/{id}", Engineer, RoleScope::Trial),
    ("GET", "/v1/trials/{id}/conditions", Reader, RoleScope::Trial),
    ("PUT", "/v1/trials/{id}/conditions", Engineer, RoleScope::Trial),
    ("GET", "/v1/trials/{id}/samples", Reader, RoleScope::Trial),
    ("POST", "/v1/trials/{id}/undelete", Engineer, RoleScope::Trial),
    // Work.
    ("POST", "/v1/refinements", Engineer, RoleScope::Body),
    ("POST", "/v1/diagnoses", Engineer, RoleScope::Body),
    ("POST", "/v1/branches", Engineer, RoleScope::Body),
    ("GET", "/v1/jobs", Reader, RoleScope::ShipOfQuery),
    // Own jobs only.
    ("DELETE", "/v1/jobs", Engineer, RoleScope::Anything),
    ("GET", "/v1/jobs/{id}", Reader, RoleScope::Job),
    ("DELETE", "/v1/jobs/{id}", Engineer, RoleScope::Job),
    ("GET", "/v1/jobs/{id}/events", Reader, RoleScope::Job),
    ("POST", "/v1/jobs/{id}/retry", Engineer, RoleScope::Job),
    ("GET", "/v1/reports/{id}", Reader, RoleScope::Report),
    // Models. To move the champion takes an approver where a second person is asked for.
    ("GET", "/v1/models/{model}/versions", Reader, MODEL),
    ("POST", "/v1/models/{model}/versions", Engineer, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/document", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/export", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/signatures", Reader, MODEL),
    ("POST", "/v1/models/{model}/versions/{number}/signatures", Engineer, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/validation", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/weights", Reader, MODEL),
    ("POST", "/v1/models/{model}/versions/{number}/verify", Reader, MODEL),
    ("GET", "/v1/models/{model}/aliases", Reader, MODEL),
    ("GET", "/v1/models/{model}/aliases/{alias}", Reader, MODEL),
    ("PUT", "/v1/models/{model}/aliases/{alias}", Engineer, MODEL),
    ("GET", "/v1/models/{model}/aliases/{alias}/history", Reader, MODEL),
    ("POST", "/v1/predictions", Reader, RoleScope::Body),
    // Sessions belong to the caller that opened them; others do not find them.
    ("GET", "/v1/sessions", Reader, RoleScope::Anything),
    ("POST", "/v1/sessions", Reader, RoleScope::Body),
    ("GET", "/v1/sessions/{id}", Reader, RoleScope::Body),
    ("DELETE", "/v1/sessions/{id}", Reader, RoleScope::Body),
    ("POST", "/v1/sessions/{id}/steps", Reader, RoleScope::Body),
    ("GET", "/v1/sessions/{id}/stream", Reader, RoleScope::Body),
    ("GET", "/v1/compare", Reader, RoleScope::Body),
    ("GET", "/v1/laws", Reader, RoleScope::Anything),
    ("POST", "/v1/laws", Engineer, RoleScope::Server),
    ("GET", "/v1/laws/{law}", Reader, RoleScope::Anything),
    ("GET", "/v1/effects", Reader, RoleScope::Anything),
    ("GET", "/v1/effects/{sha256}", Reader, RoleScope::Anything),
    // Families. Adding a ship to a family gives those with a role for the family rights on the
    // ship.
    ("GET", "/v1/families", Reader, RoleScope::Server),
    ("POST", "/v1/families", Engineer, RoleScope::Server),
    ("GET", "/v1/families/{family}", Reader, RoleScope::Family),
    ("PUT", "/v1/families/{family}", Engineer, RoleScope::Family),
    ("GET", "/v1/families/{family}/drift", Reader, RoleScope::Family),
    ("GET", "/v1/families/{family}/members", Reader, RoleScope::Family),
    ("POST", "/v1/families/{family}/members", Engineer, RoleScope::Server),
    ("DELETE", "/v1/families/{family}/members/{ship}", Engineer, RoleScope::Family),
    ("GET", "/v1/families/{family}/prior", Reader, RoleScope::Family),
    ("POST", "/v1/families/{family}/prior", Engineer, RoleScope::Family),
    ("POST", "/v1/families/{family}/refinements", Engineer, RoleScope::Family),
    ("GET", "/v1/bulk-refinements", Reader, RoleScope::FamilyOfQuery),
    ("GET", "/v1/bulk-refinements/{id}", Reader, RoleScope::Bulk),
    ("DELETE", "/v1/bulk-refinements/{id}", Engineer, RoleScope::Bulk),
    ("GET", "/v1/bulk-refinements/{id}/ships", Reader, RoleScope::Bulk),
    ("POST", "/v1/bulk-refinements/{id}/retry", Engineer, RoleScope::Bulk),
    ("POST", "/v1/bulk-refinements/{id}/champions", Engineer, RoleScope::Bulk),
    // Rights.
    ("GET", "/v1/users", Admin, RoleScope::Server),
    ("POST", "/v1/users", Admin, RoleScope::Server),
    ("GET", "/v1/users/{user}", Admin, RoleScope::Server),
    ("DELETE", "/v1/users/{user}", Admin, RoleScope::Server),
    ("POST", "/v1/users/{user}/enable", Admin, RoleScope::Server),
    ("PUT", "/v1/users/{user}/password", Admin, RoleScope::Server),
    ("PUT", "/v1/users/{user}/roles", Admin, RoleScope::Server),
    ("PUT", "/v1/users/{user}/identities", Admin, RoleScope::Server),
    ("GET", "/v1/keys", Admin, RoleScope::Server),
    ("POST", "/v1/keys", Admin, RoleScope::Server),
    ("GET", "/v1/keys/{prefix}", Admin, RoleScope::Server),
    ("DELETE", "/v1/keys/{prefix}", Admin, RoleScope::Server),
    ("PUT", "/v1/keys/{prefix}/roles", Admin, RoleScope::Server),
    ("GET", "/v1/settings", Reader, RoleScope::Anything),
    ("PUT", "/v1/settings", Admin, RoleScope::Server),
    ("GET", "/v1/webhooks", Admin, RoleScope::Server),
    ("POST", "/v1/webhooks", Admin, RoleScope::Server),
    ("GET", "/v1/webhooks/{id}", Admin, RoleScope::Server),
    ("DELETE", "/v1/webhooks/{id}", Admin, RoleScope::Server),
    ("GET", "/v1/webhooks/{id}/deliveries", Admin, RoleScope::Server),
    ("POST", "/v1/webhooks/{id}/deliveries/{delivery}/retry", Admin, RoleScope::Server),
    ("GET", "/v1/audit", Admin, RoleScope::Server),
    ("GET", "/v1/audit/head", Admin, RoleScope::Server),
    // Pages.
    ("GET", "/", Reader, RoleScope::Server),
    ("GET", "/new-ship", Engineer, RoleScope::Server),
    ("POST", "/ships", Engineer, RoleScope::Server),
    ("POST", "/example", Engineer, RoleScope::Server),
    ("GET", "/ships/{ship}", Reader, SHIP),
    ("GET", "/ships/{ship}/turn.svg", Reader, SHIP),
    ("GET", "/ships/{ship}/versions/{number}/turn.svg", Reader, SHIP),
    ("POST", "/ships/{ship}/refine", Engineer, SHIP),
    ("POST", "/ships/{ship}/diagnose", Engineer, SHIP),
    ("POST", "/ships/{ship}/champion", Engineer, SHIP),
    ("POST", "/ships/{ship}/note", Engineer, SHIP),
    ("POST", "/ships/{ship}/tag", Engineer, SHIP),
    ("POST", "/ships/{ship}/untag", Engineer, SHIP),
    ("GET", "/ships/{ship}/particulars", Engineer, SHIP),
    ("POST", "/ships/{ship}/particulars", Engineer, SHIP),
    ("GET", "/ships/{ship}/conditions", Engineer, SHIP),
    ("POST", "/ships/{ship}/conditions", Engineer, SHIP),
    ("GET", "/ships/{ship}/versions/{number}", Reader, SHIP),
    ("GET", "/ships/{ship}/versions/{number}/acceptance", Reader, SHIP),
    ("POST", "/ships/{ship}/versions/{number}/sign", Engineer, SHIP),
    ("GET", "/ships/{ship}/upload", Engineer, SHIP),
    ("POST", "/ships/{ship}/upload", Engineer, SHIP),
    ("GET", "/ships/{ship}/uploads/{draft}", Engineer, SHIP),
    ("POST", "/ships/{ship}/uploads/{draft}", Engineer, SHIP),
    ("GET", "/ships/{ship}/uploaded", Engineer, SHIP),
    ("GET", "/trials/{id}", Reader, RoleScope::Trial),
    ("GET", "/compare", Reader, RoleScope::Server),
    ("GET", "/playground", Reader, RoleScope::Server),
    ("GET", "/families", Reader, RoleScope::Server),
    ("POST", "/families", Engineer, RoleScope::Server),
    ("GET", "/families/{family}", Reader, RoleScope::Family),
    ("POST", "/families/{family}/members", Engineer, RoleScope::Server),
    ("GET", "/zoo", Reader, RoleScope::Anything),
    ("GET", "/zoo/laws/{law}", Reader, RoleScope::Anything),
    ("GET", "/zoo/effects/{effect}", Reader, RoleScope::Anything),
    ("GET", "/jobs", Reader, RoleScope::ShipOfQuery),
    ("GET", "/jobs/{id}", Reader, RoleScope::Job),
    ("POST", "/jobs/{id}/cancel", Engineer, RoleScope::Job),
    ("POST", "/jobs/{id}/retry", Engineer, RoleScope::Job),
    ("GET", "/users", Admin, RoleScope::Server),
    ("POST", "/users", Admin, RoleScope::Server),
    ("POST", "/users/{user}/roles", Admin, RoleScope::Server),
    ("POST", "/users/{user}/password", Admin, RoleScope::Server),
    ("POST", "/users/{user}/disable", Admin, RoleScope::Server),
    ("POST", "/users/{user}/enable", Admin, RoleScope::Server),
    ("POST", "/keys", Admin, RoleScope::Server),
    ("POST", "/keys/{prefix}/revoke", Admin, RoleScope::Server),
    ("POST", "/settings", Admin, RoleScope::Server),
    ("GET", "/webhooks", Admin, RoleScope::Server),
    ("POST", "/webhooks", Admin, RoleScope::Server),
    ("POST", "/webhooks/address", Admin, RoleScope::Server),
    ("POST", "/webhooks/{id}/end", Admin, RoleScope::Server),
    ("GET", "/audit", Admin, RoleScope::Server),
];

/// Role of the second person, if one is required.
pub(crate) const SECOND_PERSON: Role = Approver;

/// Returns the role that a route needs; `None` for routes without access control.
pub(super) fn route_need(method: &Method, route: &str) -> Option<RouteNeed> {
    let method = if *method == Method::HEAD { "GET" } else { method.as_str() };
    if HEALTH_ROUTES.contains(&(method, route))
        || OPEN_ROUTES.contains(&(method, route))
        || is_unknown_method(method)
    {
        return None;
    }
    if IDENTIFIED_ROUTES.contains(&(method, route)) {
        return Some(RouteNeed { role: None, of: RoleScope::Anything });
    }
    // A route that is missing in the table is for admins.
    let row = ROLE_TABLE.iter().find(|(known, at, ..)| *known == method && *at == route);
    let (role, of) = row.map_or((Admin, RoleScope::Server), |&(_, _, role, of)| (role, of));
    Some(RouteNeed { role: Some(role), of })
}

/// Returns true if no route has the method, so that the router answers 405.
fn is_unknown_method(method: &str) -> bool {
    !["GET", "PUT", "POST", "DELETE"].contains(&method)
}
