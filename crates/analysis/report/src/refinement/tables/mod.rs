//! Tables of the report of a refinement.

mod coefficients;
mod further;
mod provenance;
mod results;
mod sailed;

pub(crate) use coefficients::coefficients;
pub(crate) use further::further;
pub(crate) use provenance::{parameters, particulars, settings};
pub(crate) use results::{errors, imo, options, turns, zigzags};
pub(crate) use sailed::sailed;
