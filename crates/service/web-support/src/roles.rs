//! Roles as requests give them and answers show them.

use serde::{Deserialize, Serialize};
use sistership_auth::{Grant, Role, Scope};
use sistership_store::GrantRow;
use utoipa::ToSchema;

use crate::field::{Name, Word};
use crate::problem::{Problem, Result};

/// What somebody may do; each has the rights of those before it.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum RoleName {
    /// Reads.
    Reader,
    /// Works.
    Engineer,
    /// Promotes.
    Approver,
    /// Gives rights.
    Admin,
}

/// A role, and what it is given for: the whole server where neither ship nor family is named.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct RoleRequest {
    role: RoleName,
    /// For this ship, its trials and its models only.
    #[schema(inline)]
    ship: Option<Name>,
    /// For this family and the ships in it only.
    #[schema(inline)]
    family: Option<Word>,
}

/// A role, and what it is given for.
#[derive(Debug, Serialize, ToSchema)]
pub struct RoleView {
    /// `reader`, `engineer`, `approver` or `admin`.
    role: String,
    /// Where it is given for one ship.
    ship: Option<String>,
    /// Where it is given for one family.
    family: Option<String>,
}

impl From<RoleName> for Role {
    fn from(name: RoleName) -> Self {
        match name {
            RoleName::Reader => Self::Reader,
            RoleName::Engineer => Self::Engineer,
            RoleName::Approver => Self::Approver,
            RoleName::Admin => Self::Admin,
        }
    }
}

impl RoleView {
    /// Of a row.
    pub fn of(row: GrantRow) -> Self {
        let GrantRow { scope_kind, scope_name, role } = row;
        let name = |kind: &str| (scope_kind == kind).then(|| scope_name.clone());
        Self { role, ship: name("ship"), family: name("family") }
    }

    /// Of what is given.
    pub fn of_grant(grant: &Grant) -> Self {
        let (kind, name) = grant.scope.parts();
        let (scope_kind, scope_name) = (kind.to_owned(), name.to_owned());
        Self::of(GrantRow { scope_kind, scope_name, role: grant.role.as_str().to_owned() })
    }
}

/// The roles that a request gives.
///
/// # Errors
/// The role at fault.
pub fn grants(roles: Vec<RoleRequest>) -> Result<Vec<Grant>> {
    roles.into_iter().enumerate().map(|(at, role)| grant(at, role)).collect()
}

fn grant(at: usize, request: RoleRequest) -> Result<Grant> {
    let role = Role::from(request.role);
    let scope = match (request.ship, request.family) {
        (None, None) => Scope::Server,
        (Some(_), Some(_)) => {
            return Err(Problem::invalid(
                &format!("roles[{at}]"),
                "names a ship and a family; give two roles, or either",
            ));
        }
        (Some(ship), None) => Scope::Ship(ship.into_string()),
        (None, Some(family)) => Scope::Family(family.into_string()),
    };
    match role == Role::Admin && scope != Scope::Server {
        true => Err(Problem::invalid(
            &format!("roles[{at}].role"),
            "admin is given for the whole server only; name no ship and no family",
        )),
        false => Ok(Grant { scope, role }),
    }
}
