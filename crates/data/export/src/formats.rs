//! List of the formats.

use crate::c::C;
use crate::fmu::{Fmu2, Fmu3};
use crate::format::Format;
use crate::matlab::Matlab;
use crate::modelica::Modelica;
use crate::python::Python;

/// All formats.
pub const FORMATS: [&dyn Format; 6] = [&C, &Python, &Matlab, &Modelica, &Fmu2, &Fmu3];

/// Returns the format of a name.
pub fn by_name(name: &str) -> Option<&'static dyn Format> {
    FORMATS.into_iter().find(|format| format.name() == name)
}
