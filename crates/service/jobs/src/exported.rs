//! Versions written down for other tools.

use serde::Deserialize;
use sistership_export::{ExportError, Plan, Subject, by_name};
use sistership_model::Law;
use sistership_store::Version;
use utoipa::ToSchema;

use crate::archive::document;

/// The tool that a version is written down for; C where none is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum ExportFormat {
    /// One file of C.
    #[default]
    C,
    /// One file of Python.
    Python,
    /// A function of MATLAB.
    Matlab,
    /// A model of Modelica.
    Modelica,
    /// A functional mock-up unit of FMI 2.0.
    Fmu2,
    /// A functional mock-up unit of FMI 3.0.
    Fmu3,
}

/// A version in a format.
#[derive(Debug, Clone)]
pub struct Exported {
    /// The name of the file.
    pub file: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

impl ExportFormat {
    /// Its name among those of `sistership-export`.
    pub fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Python => "python",
            Self::Matlab => "matlab",
            Self::Modelica => "modelica",
            Self::Fmu2 => "fmu2",
            Self::Fmu3 => "fmu3",
        }
    }

    /// Writes a version down; `law` is that of its model.
    ///
    /// # Errors
    /// Says why the version cannot be exported.
    pub fn write(self, version: &Version, law: &Law) -> Result<Exported, ExportError> {
        let unreadable = |error: &dyn std::fmt::Display| ExportError::Archive(error.to_string());
        let model = document(version).map_err(|error| unreadable(&error))?.model;
        let line = format!("{}/{}", version.head.model, version.head.number);
        let sha256 = version.head.sha256.clone();
        let plan = Plan::new(&Subject { model: &model, law, version: Some(line), sha256 })?;
        let format = by_name(self.name()).ok_or_else(|| unreadable(&"there is no such format"))?;
        let file = format!("{}.{}", plan.identifier, format.extension());
        Ok(Exported { file, bytes: format.write(&plan)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sistership_export::FORMATS;

    #[test]
    fn every_format_can_be_asked_for() {
        let asked = FORMATS.map(|format| {
            let name = format!("\"{}\"", format.name());
            serde_json::from_str::<ExportFormat>(&name).map_or("", ExportFormat::name)
        });
        assert_eq!(asked, FORMATS.map(|format| format.name()));
    }
}
