//! Roles, each with the rights of those before it.

use std::fmt;
use std::str::FromStr;

/// Role of a user or key. Each role includes the rights of those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Reads ships, trials, models and reports, and predicts with them.
    Reader,
    /// Creates ships, uploads trials, refines, diagnoses, and moves aliases; `champion` too, unless
    /// a second person is required.
    Engineer,
    /// Promotes versions made by others.
    Approver,
    /// Grants and revokes roles, and reads the audit.
    Admin,
}

impl Role {
    /// All roles, the lowest first.
    pub const ALL: [Self; 4] = [Self::Reader, Self::Engineer, Self::Approver, Self::Admin];

    /// Returns its name, as it is stored and shown.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Reader => "reader",
            Self::Engineer => "engineer",
            Self::Approver => "approver",
            Self::Admin => "admin",
        }
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl FromStr for Role {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let role = Self::ALL.into_iter().find(|role| role.as_str() == name);
        role.ok_or_else(|| {
            format!("there is no role `{name}`; choose one of reader, engineer, approver and admin")
        })
    }
}
