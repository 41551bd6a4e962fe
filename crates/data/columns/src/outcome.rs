//! Result of the identification of columns, with probabilities.

use crate::role::Role;

/// Quantity, unit and sign identified for a column.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedColumn {
    /// Header of the column.
    pub header: String,
    /// Quantity of the column; `None` for a column that is not read.
    pub role: Option<Role>,
    /// Unit by its name in manifests.
    pub unit: String,
    /// True if the sign of the column is opposite to that of the channel: rudder positive to port,
    /// heading anticlockwise.
    pub is_reversed: bool,
    /// Posterior probability, given the assignment of the other columns.
    pub probability: f64,
    /// True if the column needs no confirmation: the probability is high, and a name or a relation
    /// supports it.
    pub is_certain: bool,
    /// Evidence as text for the user.
    pub reason: String,
    /// Second likeliest hypothesis, where it is nearly as likely.
    pub alternative: Option<AlternativeReading>,
    /// Quantity named by the header for which there is no channel.
    pub other: Option<String>,
}

/// Alternative hypothesis for a column.
#[derive(Debug, Clone, PartialEq)]
pub struct AlternativeReading {
    /// Quantity of the column; `None` for a column that is not read.
    pub role: Option<Role>,
    /// Unit by its name in manifests.
    pub unit: String,
    /// True if the sign of the column is opposite to that of the channel.
    pub is_reversed: bool,
    /// Posterior probability.
    pub probability: f64,
}

/// Two thruster commands whose difference steers.
#[derive(Debug, Clone, PartialEq)]
pub struct ThrusterPair {
    /// Indices of the port and the starboard column.
    pub columns: (usize, usize),
    /// True if one command has the opposite sign, so that their sum steers.
    pub is_opposed: bool,
    /// Correlation of the steering combination with the yaw rate.
    pub yaw_correlation: f64,
    /// Correlation of the driving combination with the speed ahead.
    pub speed_correlation: f64,
}

/// The identified columns of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Identification {
    /// One entry for each column of the recording.
    pub columns: Vec<IdentifiedColumn>,
    /// Pair of thruster commands, where there is one.
    pub thrusters: Option<ThrusterPair>,
}

impl Identification {
    /// Returns the column of a role.
    pub fn find(&self, role: Role) -> Option<&IdentifiedColumn> {
        self.columns.iter().find(|column| column.role == Some(role))
    }
}
