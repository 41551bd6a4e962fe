//! The role that each route needs, and its scope: the only place that says so. A route that is
//! missing here is for admins; a test checks that none is.

use axum::http::Method;
use sistership_auth::Role;

use Role::{Admin, Approver, Engineer, Reader};

/// Role that a route needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Need {
    /// The least role; `None` if any identified caller may use the route.
    pub role: Option<Role>,
    /// Object for which the role must be given, if it is not given for the server.
    pub of: Of,
}

/// Object for which a role must be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Of {
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

impl Of {
    /// The object in words.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Server => "the server",
            Self::Anything => "anything",
            Self::Ship(_) | Self::Job | Self::Trial | Self::Report | Self::Body => "the ship",
            Self::ShipOfQuery => "the ship of the query, or the server",
            Self::Family | Self::Bulk => "the family",
            Self::FamilyOfQuery => "the family of the query, or the server",
        }
    }
}

/// Method, route, role and scope.
pub(crate) type Row = (&'static str, &'static str, Role, Of);

/// Routes that need no key, under any host name: their answers hold nothing worth protecting.
pub(crate) const HEALTH: [(&str, &str); 3] =
    [("GET", "/healthz"), ("GET", "/readyz"), ("GET", "/openapi.json")];

/// Routes of signing in.
pub(crate) const OPEN: [(&str, &str); 4] = [
    ("GET", "/sign-in"),
    ("POST", "/sign-in"),
    ("GET", "/sign-in/oidc"),
    ("GET", "/sign-in/oidc/callback"),
];

/// Routes for any identified caller.
pub(crate) const ANYONE: [(&str, &str); 5] = [
    ("GET", "/v1/me"),
    ("GET", "/account"),
    ("POST", "/account/password"),
    ("POST", "/account/identity"),
    ("POST", "/sign-out"),
];

const SHIP: Of = Of::Ship("ship");
const MODEL: Of = Of::Ship("model");

/// All routes but those of the three lists above.
#[rustfmt::skip]
pub(crate) const TABLE: &[Row] = &[
    ("GET", "/metrics", Reader, Of::Server),
    // Ships.
    ("GET", "/v1/ships", Reader, Of::Server),
    ("POST", "/v1/ships", Engineer, Of::Server),
    ("GET", "/v1/ships/{ship}", Reader, SHIP),
    ("PUT", "/v1/ships/{ship}", Engineer, SHIP),
    ("DELETE", "/v1/ships/{ship}", Engineer, SHIP),
    ("POST", "/v1/ships/{ship}/undelete", Engineer, SHIP),
    ("GET", "/v1/ships/{ship}/drift", Reader, SHIP),
    ("GET", "/v1/ships/{ship}/model", Reader, SHIP),
    ("GET", "/v1/ships/{ship}/notes", Reader, SHIP),
    ("POST", "/v1/ships/{ship}/notes", Engineer, SHIP),
    ("GET", "/v1/ships/{ship}/similar", Reader, SHIP),
    ("GET", "/v1/ships/{ship}/tags", Reader, SHIP),
    ("PUT", "/v1/ships/{ship}/tags/{tag}", Engineer, SHIP),
    ("DELETE", "/v1/ships/{ship}/tags/{tag}", Engineer, SHIP),
    // Trials.
    ("GET", "/v1/trials", Reader, Of::ShipOfQuery),
    ("POST", "/v1/trials", Engineer, Of::Body),
    ("POST", "/v1/trials/check", Reader, Of::Anything),
    ("GET", "/v1/trials/{id}", Reader, Of::Trial),
    ("DELETE", "/v1/trials/{id}", Engineer, Of::Trial),
    ("GET", "/v1/trials/{id}/samples", Reader, Of::Trial),
    ("POST", "/v1/trials/{id}/undelete", Engineer, Of::Trial),
    // Work.
    ("POST", "/v1/refinements", Engineer, Of::Body),
    ("POST", "/v1/diagnoses", Engineer, Of::Body),
    ("POST", "/v1/branches", Engineer, Of::Body),
    ("GET", "/v1/jobs", Reader, Of::ShipOfQuery),
    ("GET", "/v1/jobs/{id}", Reader, Of::Job),
    ("DELETE", "/v1/jobs/{id}", Engineer, Of::Job),
    ("GET", "/v1/jobs/{id}/events", Reader, Of::Job),
    ("POST", "/v1/jobs/{id}/retry", Engineer, Of::Job),
    ("GET", "/v1/reports/{id}", Reader, Of::Report),
    // Models. To move the champion takes an approver where a second person is asked for.
    ("GET", "/v1/models/{model}/versions", Reader, MODEL),
    ("POST", "/v1/models/{model}/versions", Engineer, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/document", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/export", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/validation", Reader, MODEL),
    ("GET", "/v1/models/{model}/versions/{number}/weights", Reader, MODEL),
    ("POST", "/v1/models/{model}/versions/{number}/verify", Reader, MODEL),
    ("GET", "/v1/models/{model}/aliases", Reader, MODEL),
    ("GET", "/v1/models/{model}/aliases/{alias}", Reader, MODEL),
    ("PUT", "/v1/models/{model}/aliases/{alias}", Engineer, MODEL),
    ("GET", "/v1/models/{model}/aliases/{alias}/history", Reader, MODEL),
    ("POST", "/v1/predictions", Reader, Of::Body),
    // Sessions belong to the caller that opened them; others do not find them.
    ("GET", "/v1/sessions", Reader, Of::Anything),
    ("POST", "/v1/sessions", Reader, Of::Body),
    ("GET", "/v1/sessions/{id}", Reader, Of::Body),
    ("DELETE", "/v1/sessions/{id}", Reader, Of::Body),
    ("POST", "/v1/sessions/{id}/steps", Reader, Of::Body),
    ("GET", "/v1/sessions/{id}/stream", Reader, Of::Body),
    ("GET", "/v1/compare", Reader, Of::Body),
    ("GET", "/v1/laws", Reader, Of::Anything),
    ("POST", "/v1/laws", Engineer, Of::Server),
    ("GET", "/v1/laws/{law}", Reader, Of::Anything),
    ("GET", "/v1/effects", Reader, Of::Anything),
    ("GET", "/v1/effects/{sha256}", Reader, Of::Anything),
    // Families. Adding a ship to a family gives those with a role for the family rights on the
    // ship.
    ("GET", "/v1/families", Reader, Of::Server),
    ("POST", "/v1/families", Engineer, Of::Server),
    ("GET", "/v1/families/{family}", Reader, Of::Family),
    ("PUT", "/v1/families/{family}", Engineer, Of::Family),
    ("GET", "/v1/families/{family}/drift", Reader, Of::Family),
    ("GET", "/v1/families/{family}/members", Reader, Of::Family),
    ("POST", "/v1/families/{family}/members", Engineer, Of::Server),
    ("DELETE", "/v1/families/{family}/members/{ship}", Engineer, Of::Family),
    ("GET", "/v1/families/{family}/prior", Reader, Of::Family),
    ("POST", "/v1/families/{family}/prior", Engineer, Of::Family),
    ("POST", "/v1/families/{family}/refinements", Engineer, Of::Family),
    ("GET", "/v1/bulk-refinements", Reader, Of::FamilyOfQuery),
    ("GET", "/v1/bulk-refinements/{id}", Reader, Of::Bulk),
    ("DELETE", "/v1/bulk-refinements/{id}", Engineer, Of::Bulk),
    ("GET", "/v1/bulk-refinements/{id}/ships", Reader, Of::Bulk),
    ("POST", "/v1/bulk-refinements/{id}/retry", Engineer, Of::Bulk),
    ("POST", "/v1/bulk-refinements/{id}/champions", Engineer, Of::Bulk),
    // Rights.
    ("GET", "/v1/users", Admin, Of::Server),
    ("POST", "/v1/users", Admin, Of::Server),
    ("GET", "/v1/users/{user}", Admin, Of::Server),
    ("DELETE", "/v1/users/{user}", Admin, Of::Server),
    ("POST", "/v1/users/{user}/enable", Admin, Of::Server),
    ("PUT", "/v1/users/{user}/password", Admin, Of::Server),
    ("PUT", "/v1/users/{user}/roles", Admin, Of::Server),
    ("PUT", "/v1/users/{user}/identities", Admin, Of::Server),
    ("GET", "/v1/keys", Admin, Of::Server),
    ("POST", "/v1/keys", Admin, Of::Server),
    ("GET", "/v1/keys/{prefix}", Admin, Of::Server),
    ("DELETE", "/v1/keys/{prefix}", Admin, Of::Server),
    ("PUT", "/v1/keys/{prefix}/roles", Admin, Of::Server),
    ("GET", "/v1/settings", Reader, Of::Anything),
    ("PUT", "/v1/settings", Admin, Of::Server),
    ("GET", "/v1/webhooks", Admin, Of::Server),
    ("POST", "/v1/webhooks", Admin, Of::Server),
    ("GET", "/v1/webhooks/{id}", Admin, Of::Server),
    ("DELETE", "/v1/webhooks/{id}", Admin, Of::Server),
    ("GET", "/v1/webhooks/{id}/deliveries", Admin, Of::Server),
    ("POST", "/v1/webhooks/{id}/deliveries/{delivery}/retry", Admin, Of::Server),
    ("GET", "/v1/audit", Admin, Of::Server),
    ("GET", "/v1/audit/head", Admin, Of::Server),
    // Pages.
    ("GET", "/", Reader, Of::Server),
    ("GET", "/new-ship", Engineer, Of::Server),
    ("POST", "/ships", Engineer, Of::Server),
    ("GET", "/ships/{ship}", Reader, SHIP),
    ("POST", "/ships/{ship}/refine", Engineer, SHIP),
    ("POST", "/ships/{ship}/diagnose", Engineer, SHIP),
    ("POST", "/ships/{ship}/champion", Engineer, SHIP),
    ("POST", "/ships/{ship}/note", Engineer, SHIP),
    ("POST", "/ships/{ship}/tag", Engineer, SHIP),
    ("POST", "/ships/{ship}/untag", Engineer, SHIP),
    ("GET", "/ships/{ship}/versions/{number}", Reader, SHIP),
    ("GET", "/ships/{ship}/upload", Engineer, SHIP),
    ("POST", "/ships/{ship}/upload", Engineer, SHIP),
    ("GET", "/ships/{ship}/uploads/{draft}", Engineer, SHIP),
    ("POST", "/ships/{ship}/uploads/{draft}", Engineer, SHIP),
    ("GET", "/trials/{id}", Reader, Of::Trial),
    ("GET", "/compare", Reader, Of::Server),
    ("GET", "/playground", Reader, Of::Server),
    ("GET", "/families", Reader, Of::Server),
    ("GET", "/families/{family}", Reader, Of::Family),
    ("GET", "/zoo", Reader, Of::Anything),
    ("GET", "/zoo/laws/{law}", Reader, Of::Anything),
    ("GET", "/zoo/effects/{effect}", Reader, Of::Anything),
    ("GET", "/jobs", Reader, Of::ShipOfQuery),
    ("GET", "/jobs/{id}", Reader, Of::Job),
    ("POST", "/jobs/{id}/cancel", Engineer, Of::Job),
    ("POST", "/jobs/{id}/retry", Engineer, Of::Job),
    ("GET", "/users", Admin, Of::Server),
    ("POST", "/users", Admin, Of::Server),
    ("POST", "/users/{user}/roles", Admin, Of::Server),
    ("POST", "/users/{user}/password", Admin, Of::Server),
    ("POST", "/users/{user}/disable", Admin, Of::Server),
    ("POST", "/users/{user}/enable", Admin, Of::Server),
    ("POST", "/keys", Admin, Of::Server),
    ("POST", "/keys/{prefix}/revoke", Admin, Of::Server),
    ("POST", "/settings", Admin, Of::Server),
    ("GET", "/audit", Admin, Of::Server),
];

/// Role of the second person, if one is required.
pub(crate) const SECOND_PERSON: Role = Approver;

/// Returns the role that a route needs; `None` for routes without access control.
pub(super) fn need(method: &Method, route: &str) -> Option<Need> {
    let method = if *method == Method::HEAD { "GET" } else { method.as_str() };
    if HEALTH.contains(&(method, route)) || OPEN.contains(&(method, route)) || is_unknown(method) {
        return None;
    }
    if ANYONE.contains(&(method, route)) {
        return Some(Need { role: None, of: Of::Anything });
    }
    // A route that is missing in the table is for admins.
    let row = TABLE.iter().find(|(known, at, ..)| *known == method && *at == route);
    let (role, of) = row.map_or((Admin, Of::Server), |&(_, _, role, of)| (role, of));
    Some(Need { role: Some(role), of })
}

/// Returns true if no route has the method, so that the router answers 405.
fn is_unknown(method: &str) -> bool {
    !["GET", "PUT", "POST", "DELETE"].contains(&method)
}
