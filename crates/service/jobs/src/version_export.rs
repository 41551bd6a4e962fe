//! Export of versions to other tools.

use serde::Deserialize;
use sistership_export::{ExportError, ExportSubject, by_name};
use sistership_model::{Law, Model};
use sistership_store::Version;
use utoipa::ToSchema;

/// Format of an export; C by default.
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
    /// A package of SSP 1.0: a functional mock-up unit of FMI 2.0 with its parameter values.
    Ssp,
}

/// Exported version.
#[derive(Debug, Clone)]
pub struct ExportedFile {
    /// The name of the file.
    pub file: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

impl ExportFormat {
    /// Its name in `sistership-export`.
    pub fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Python => "python",
            Self::Matlab => "matlab",
            Self::Modelica => "modelica",
            Self::Fmu2 => "fmu2",
            Self::Fmu3 => "fmu3",
            Self::Ssp => "ssp",
        }
    }

    /// Writes a version as a file, from its model with the weights of a learned correction
    /// attached, and its law.
    ///
    /// # Errors
    /// Returns an error if the version cannot be exported in this format.
    pub fn export_version(
        self,
        version: &Version,
        (model, law): (&Model, &Law),
    ) -> Result<ExportedFile, ExportError> {
        let missing = || ExportError::Archive("there is no such format".to_owned());
        let line = format!("{}/{}", version.head.model, version.head.number);
        let sha256 = version.head.sha256.clone();
        // The exported file names the version and its hash, so that it can be traced.
        let format = by_name(self.name()).ok_or_else(missing)?;
        let subject = ExportSubject { model, law, version: Some(line), sha256 };
        let plan = format.prepare(&subject)?;
        let file = format!("{}.{}", plan.identifier, format.extension());
        Ok(ExportedFile { file, bytes: format.write(&plan)? })
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
        let known = FORMATS.map(|format| format.name());
        assert_eq!(asked, known, "add each of `FORMATS` to `ExportFormat`, by the same name");
    }
}
