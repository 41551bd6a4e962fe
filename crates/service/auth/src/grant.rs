//! Roles with their scope.

use std::fmt;
use std::str::FromStr;

use crate::role::Role;

/// Scope of a role.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Scope {
    /// The whole server.
    Server,
    /// One ship, its trials and its models.
    Ship(String),
    /// A family and the ships in it.
    Family(String),
}

impl Scope {
    /// Returns kind and name, as they are stored.
    pub fn to_parts(&self) -> (&'static str, &str) {
        match self {
            Self::Server => ("server", ""),
            Self::Ship(name) => ("ship", name),
            Self::Family(name) => ("family", name),
        }
    }

    /// Creates a scope from kind and name, see [`Scope::parts`]; none if the kind is unknown.
    pub fn from_parts(kind: &str, name: &str) -> Option<Self> {
        match kind {
            "server" => Some(Self::Server),
            "ship" => Some(Self::Ship(name.to_owned())),
            "family" => Some(Self::Family(name.to_owned())),
            _ => None,
        }
    }
}

/// A role for something, written `role`, `role@ship:NAME` or `role@family:NAME`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Grant {
    /// The scope.
    pub scope: Scope,
    /// The role.
    pub role: Role,
}

impl Grant {
    /// Creates a role for the whole server.
    pub fn on_server(role: Role) -> Self {
        Self { scope: Scope::Server, role }
    }
}

impl fmt::Display for Grant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.scope {
            Scope::Server => write!(f, "{}", self.role),
            Scope::Ship(name) => write!(f, "{}@ship:{name}", self.role),
            Scope::Family(name) => write!(f, "{}@family:{name}", self.role),
        }
    }
}

impl FromStr for Grant {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Without a scope the role is for the whole server.
        let Some((role, scope)) = text.split_once('@') else {
            return Ok(Self::on_server(text.parse()?));
        };
        let role: Role = role.parse()?;
        let scope = match scope.split_once(':').filter(|(_, name)| !name.is_empty()) {
            Some((kind @ ("ship" | "family"), name)) => Scope::from_parts(kind, name),
            _ => None,
        };
        let scope = scope.ok_or_else(|| {
            format!(
                "`{text}` is not a role; write reader, engineer@ship:NAME or \
                     approver@family:NAME"
            )
        })?;
        match role {
            // An administrator manages users and keys, which belong to no ship or family.
            Role::Admin => {
                Err("the role admin cannot be restricted to a ship or family".to_owned())
            }
            role => Ok(Self { scope, role }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grants_are_read_as_they_are_written() {
        for text in ["reader", "admin", "engineer@ship:kvlcc2", "approver@family:tankers"] {
            assert_eq!(text.parse::<Grant>().map(|grant| grant.to_string()), Ok(text.to_owned()));
        }
        for wrong in ["captain", "reader@", "reader@ship:", "reader@fleet:a", "admin@ship:a", ""] {
            assert!(wrong.parse::<Grant>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn scopes_are_stored_by_their_parts() {
        for scope in [Scope::Server, Scope::Ship("a".into()), Scope::Family("b".into())] {
            let (kind, name) = scope.to_parts();
            assert_eq!(Scope::from_parts(kind, name), Some(scope.clone()));
        }
        assert_eq!(Scope::from_parts("fleet", "a"), None);
    }
}
