//! Laws of motion: definition, reading and checks.

mod additions;
mod definition;
mod dimension;
mod error;
mod file;
mod helm;
pub(crate) mod limits;
mod read;
mod submodel;
mod symmetry;
mod typical;

pub use additions::{LawAdditions, StraightAhead};
pub use definition::{
    AxisLaw, CoefficientPrior, Law, LawInput, LawParameter, LawSubmodel, indicator_name,
};
pub use dimension::{STATES, acceleration_dimension, axis_dimension};
pub use error::TermError;
pub use file::{
    AxisFile, CoefficientPriorFile, InputFile, LawFile, LawKind, ParameterFile, ParameterPrior,
    SubmodelFile, TermFile,
};
pub use helm::{helm_value, set_actuators};
pub use limits::{MAX_COEFFICIENTS, MAX_EFFECTS, MAX_SIZE, MAX_TERMS};
pub use typical::{TrialApproach, TypicalValue};
