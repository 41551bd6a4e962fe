//! What may be chosen of a bulk refinement.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Where a member starts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// At its champion; at the family's foundation where it has none.
    #[default]
    Champion,
    /// At the family's foundation, carried over to its particulars.
    Foundation,
}

/// What holds the coefficients.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum PriorChoice {
    /// What the family has taught last.
    #[default]
    Family,
    /// The foundation's coefficients.
    Foundation,
}

/// What makes a champion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rule {
    /// A refined model becomes champion where no axis' error, on trials left out, exceeds the one
    /// before by more than this share. Where absent, a person's word only.
    pub no_worse_than: Option<f64>,
}
