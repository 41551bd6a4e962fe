//! The equations of motion of a law for a model, and their lowering to tapes.
//!
//! [`EquationsOfMotion`] is set up once from the law, the coefficients and the effects of a model,
//! and has the formulas of forces, masses, added accelerations and kinematics. [`Lowering`] puts
//! these formulas on a tape; [`PlantError`] is the only error type. Each use is a view that takes
//! what it needs: simulation ([`Plant`](crate::Plant)), readings of instruments
//! ([`Instruments`](crate::instruments::Instruments)), candidates whose coefficients are data
//! ([`CandidateSystem`](crate::candidates::CandidateSystem)), sensitivities
//! ([`SensitiveSystem`](crate::sensitivity::SensitiveSystem)), the residuals of a filter and the
//! rows of a regression.

mod definition;
mod lowering;
mod mobility;
mod plant_error;

pub use definition::{AxesAttitude, CoefficientBinding, EquationsOfMotion};
pub use lowering::EquationLowering;
pub(crate) use mobility::{constant_mobility, solve_mobility};
pub use plant_error::PlantError;

#[cfg(test)]
mod tests;
