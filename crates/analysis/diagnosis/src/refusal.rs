//! Reasons for which a hypothesis is not accepted.

use std::fmt;

/// Reason for which a hypothesis is not accepted.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Refusal {
    /// The coefficients of a form are far from all published ones.
    NotAsPublished(String),
    /// The size of an effect is zero within its error.
    NoSize(String),
    /// The evidence for an effect is below the least.
    LittleEvidence { effect: String, evidence: f64, least: f64 },
    /// Differences between published forms of the other effects may explain as much.
    FormError { effect: String, evidence: f64, allowance: f64 },
    /// Held-out trials are not more probable with it.
    HeldOut { gain: f64 },
    /// Records of other times or directions explain the trials as well.
    Placebo(String),
    /// Another hypothesis has more evidence.
    Behind(String),
    /// It does not exceed the effect that it would replace.
    NotBetter,
    /// The effect differs between the parts of the trials.
    NotConstant(String),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAsPublished(effect) => {
                write!(f, "the coefficients of `{effect}` would be far from all published ones")
            }
            Self::NoSize(effect) => write!(f, "the size of `{effect}` is zero within its error"),
            Self::LittleEvidence { effect, evidence, least } => write!(
                f,
                "the evidence for `{effect}` given the others is {evidence:.1}, after the discount \
                 for clean trials, and {least:.1} is needed"
            ),
            Self::FormError { effect, evidence, allowance } => write!(
                f,
                "the evidence for `{effect}` is {evidence:.0}, and differences between published \
                 forms of the other effects may account for {allowance:.0}"
            ),
            Self::HeldOut { gain } => {
                write!(f, "held-out trials are less probable with it, by {:.1}", -gain)
            }
            Self::Placebo(effect) => write!(
                f,
                "records of other times or directions explain the trials as well as `{effect}`"
            ),
            Self::Behind(other) => write!(f, "`{other}` has more evidence"),
            Self::NotBetter => write!(f, "it does not exceed the effect that it would replace"),
            Self::NotConstant(effect) => {
                write!(f, "`{effect}` would have different sizes in the parts of the trials")
            }
        }
    }
}
