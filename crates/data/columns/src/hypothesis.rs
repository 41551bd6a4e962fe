//! Hypotheses on the content of a column: a quantity, its unit and its sign.

use crate::role::{Role, Unit};

/// Quantity, unit and sign that a column may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hypothesis {
    pub role: Role,
    pub unit: Unit,
    /// True if the sign of the column is opposite to that of the channel.
    pub is_reversed: bool,
}

impl Hypothesis {
    /// Returns the factor from the numbers of the column to SI units and canonical sign.
    pub(crate) fn si_factor(&self) -> f64 {
        if self.is_reversed { -self.unit.to_si } else { self.unit.to_si }
    }

    /// Returns the hypotheses of every unit and sign of a role.
    pub(crate) fn for_role(role: Role) -> impl Iterator<Item = Self> {
        Self::in_units(role, role.kind().known_units().iter().copied())
    }

    /// Returns the hypotheses of a role in per cent of a full scale; none for a role that is not
    /// recorded so.
    pub(crate) fn in_percent(role: Role) -> impl Iterator<Item = Self> {
        Self::in_units(role, role.kind().percent_unit().into_iter())
    }

    fn in_units(role: Role, units: impl Iterator<Item = Unit>) -> impl Iterator<Item = Self> {
        let signs: &[bool] = if role.is_signed() { &[false, true] } else { &[false] };
        units.flat_map(move |unit| {
            signs.iter().map(move |&is_reversed| Self { role, unit, is_reversed })
        })
    }
}

/// Hypothesis assigned to each column; `None` for a column that is not read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Assignment {
    pub columns: Vec<Option<Hypothesis>>,
    /// Seconds in the unit of the time column.
    pub time_factor: f64,
}

impl Assignment {
    /// Returns the index of the column with a role, and its factor to SI units.
    pub(crate) fn find(&self, role: Role) -> Option<(usize, f64)> {
        let of_role = |one: &Option<Hypothesis>| one.is_some_and(|one| one.role == role);
        let at = self.columns.iter().position(of_role)?;
        Some((at, self.columns[at]?.si_factor()))
    }

    pub(crate) fn has_role(&self, role: Role) -> bool {
        self.find(role).is_some()
    }

    /// Returns the assignment with another hypothesis for a column; a column that had the same role
    /// becomes free.
    pub(crate) fn with_column(&self, column: usize, to: Option<Hypothesis>) -> Self {
        let mut other = self.clone();
        if let Some(to) = to.filter(|to| to.role != Role::Other) {
            // A role occurs only once.
            for one in &mut other.columns {
                if one.is_some_and(|one| one.role == to.role) {
                    *one = None;
                }
            }
        }
        other.columns[column] = to;
        other
    }
}
