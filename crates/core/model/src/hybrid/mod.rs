//! The Abkowitz-MMG hybrid as a derived law: Miyauchi, Akimoto and Maki (2024), sec. 2.2.
//!
//! A declaration names the actuators, the order, the rules and the submodels; from it follow the
//! variables (Eqs. 5 and 6), the Taylor expansion (Eqs. 7 to 11), the selection (modifications A to
//! C), the conditions (Algorithms 1 to 3) and a law's file that reads like one written by hand.

mod actuators;
mod check;
mod derivation;
mod file;
mod law_file;
mod monomial;
mod rules;
mod submodels;
mod unknowns;

pub use derivation::{LawDerivation, derive_law};
pub use file::{
    ActuatorFile, ActuatorKind, AngleFeature, Coupling, EffectUse, ExceptionFile, HybridFile,
    Rules, Scaling, Scheme, Squares, StallFile, SubmodelsFile, Symmetry, TrigonometricPowers,
};
pub use rules::{HYBRID_AXES, SelectionStep};
pub use unknowns::{EffectUnknowns, RuleCount, UnknownCounts};

#[cfg(test)]
mod tests;
