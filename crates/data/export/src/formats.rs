//! List of the formats.

use crate::c::CFormat;
use crate::fmu::{Fmi2Format, Fmi3Format};
use crate::format::ModelFormat;
use crate::matlab::MatlabFormat;
use crate::modelica::ModelicaFormat;
use crate::python::PythonFormat;
use crate::ssp::SspFormat;

/// All formats.
pub const FORMATS: [&dyn ModelFormat; 7] =
    [&CFormat, &PythonFormat, &MatlabFormat, &ModelicaFormat, &Fmi2Format, &Fmi3Format, &SspFormat];

/// Returns the format of a name.
pub fn by_name(name: &str) -> Option<&'static dyn ModelFormat> {
    FORMATS.into_iter().find(|format| format.name() == name)
}
