//! What the columns of a recording are, and how sure that is.

use crate::role::Role;

/// What a column was taken for.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedColumn {
    /// Its header.
    pub header: String,
    /// Nothing for a column that is left out.
    pub role: Option<Role>,
    /// Its unit in manifests.
    pub unit: String,
    /// Whether it counts the other way: the rudder to port, the heading anticlockwise.
    pub is_reversed: bool,
    /// Posterior probability, the other columns being what they are taken for.
    pub probability: f64,
    /// Whether nobody need look: the probability is high, and a name or a relation bears it.
    pub is_certain: bool,
    /// Evidence, for a reader.
    pub reason: String,
    /// The second likeliest reading, where it is nearly as likely.
    pub alternative: Option<Alternative>,
    /// What the header names, where no channel holds it.
    pub other: Option<String>,
}

/// Another reading of a column.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternative {
    /// Nothing for a column that is left out.
    pub role: Option<Role>,
    /// Its unit in manifests.
    pub unit: String,
    /// Whether it counts the other way.
    pub is_reversed: bool,
    /// Posterior probability.
    pub probability: f64,
}

/// Two thruster commands whose difference steers.
#[derive(Debug, Clone, PartialEq)]
pub struct ThrusterPair {
    /// Places of the port and the starboard column.
    pub columns: (usize, usize),
    /// Whether one of them counts the other way, so that their sum steers.
    pub is_opposed: bool,
    /// Correlation of what steers with the yaw rate.
    pub yaw_correlation: f64,
    /// Correlation of what drives with the speed ahead.
    pub speed_correlation: f64,
}

/// The identified columns of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Identification {
    /// One for each column of the recording.
    pub columns: Vec<IdentifiedColumn>,
    /// Two commands of thrusters, where there are such.
    pub thrusters: Option<ThrusterPair>,
}

impl Identification {
    /// The column of a role.
    pub fn find(&self, role: Role) -> Option<&IdentifiedColumn> {
        self.columns.iter().find(|column| column.role == Some(role))
    }
}
