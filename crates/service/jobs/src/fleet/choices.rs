//! Options of a bulk refinement.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Starting model of a member.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// Its champion, or the family's foundation if it has none.
    #[default]
    Champion,
    /// The family's foundation, transferred to its particulars.
    Foundation,
}

/// Prior of the coefficients.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum PriorChoice {
    /// The latest prior of the family.
    #[default]
    Family,
    /// The foundation's coefficients.
    Foundation,
}

/// Rule by which a refined model becomes champion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rule {
    /// A refined model becomes champion if no axis' error on held-out trials exceeds that of the
    /// present champion by more than this share. By default only a person promotes it.
    pub no_worse_than: Option<f64>,
}
