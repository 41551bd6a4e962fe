//! Roles in requests and answers.

use serde::{Deserialize, Serialize};
use sistership_auth::{Grant, Role, Scope};
use sistership_store::GrantRow;
use utoipa::ToSchema;

use crate::field::{Name, Word};
use crate::problem::{Problem, Result};

/// Role of a user or key; each includes the rights of those before it.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum RoleName {
    /// Reads and predicts.
    Reader,
    /// Creates ships, uploads, refines and diagnoses.
    Engineer,
    /// Promotes versions.
    Approver,
    /// Manages rights.
    Admin,
}

/// A role with its scope: the whole server if neither ship nor family is given.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct RoleRequest {
    role: RoleName,
    /// Limits the role to this ship, its trials and its models.
    #[schema(inline)]
    ship: Option<Name>,
    /// Limits the role to this family and its ships.
    #[schema(inline)]
    family: Option<Word>,
}

/// A role with its scope.
#[derive(Debug, Serialize, ToSchema)]
pub struct RoleView {
    /// `reader`, `engineer`, `approver` or `admin`.
    role: String,
    /// Ship to which the role is limited.
    ship: Option<String>,
    /// Family to which the role is limited.
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
    /// Creates the view of a stored role.
    pub fn from_row(row: GrantRow) -> Self {
        let GrantRow { scope_kind, scope_name, role } = row;
        let name = |kind: &str| (scope_kind == kind).then(|| scope_name.clone());
        Self { role, ship: name("ship"), family: name("family") }
    }

    /// Creates the view of a role.
    pub fn from_grant(grant: &Grant) -> Self {
        let (kind, name) = grant.scope.to_parts();
        let (scope_kind, scope_name) = (kind.to_owned(), name.to_owned());
        Self::from_row(GrantRow { scope_kind, scope_name, role: grant.role.as_str().to_owned() })
    }
}

/// Converts the roles of a request.
///
/// # Errors
/// Returns an error that names the invalid role.
pub fn parse_grants(roles: Vec<RoleRequest>) -> Result<Vec<Grant>> {
    roles.into_iter().enumerate().map(|(at, role)| parse_grant(at, role)).collect()
}

fn parse_grant(at: usize, request: RoleRequest) -> Result<Grant> {
    let role = Role::from(request.role);
    let scope = match (request.ship, request.family) {
        (None, None) => Scope::Server,
        (Some(_), Some(_)) => {
            return Err(Problem::invalid(
                &format!("roles[{at}]"),
                "has a ship and a family; give one of them, or two roles",
            ));
        }
        (Some(ship), None) => Scope::Ship(ship.into_string()),
        (None, Some(family)) => Scope::Family(family.into_string()),
    };
    // The rights of an administrator are not limited to a ship or a family.
    match role == Role::Admin && scope != Scope::Server {
        true => Err(Problem::invalid(
            &format!("roles[{at}].role"),
            "admin cannot be restricted; give neither ship nor family",
        )),
        false => Ok(Grant { scope, role }),
    }
}
