//! Roles, each with the rights of those before it.

use std::fmt;
use std::str::FromStr;

/// What somebody may do. Each role may do all that the ones before it may.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Looks at ships, trials, models and reports, and predicts with them.
    Reader,
    /// Creates ships, uploads trials, refines, diagnoses, and moves aliases; the champion too,
    /// where no second person is asked for.
    Engineer,
    /// Promotes what others have made.
    Approver,
    /// Gives and takes rights, and reads the audit.
    Admin,
}

impl Role {
    /// All of them, the least first.
    pub const ALL: [Self; 4] = [Self::Reader, Self::Engineer, Self::Approver, Self::Admin];

    /// Its name, as it is stored and shown.
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
            format!("there is no role `{name}`; there are reader, engineer, approver and admin")
        })
    }
}
