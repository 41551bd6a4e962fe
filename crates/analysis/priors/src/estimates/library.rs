//! Embedded regressions.

use include_dir::{Dir, include_dir};
use rayon::prelude::*;
use sistership_model::FileError;
use sistership_model::version::sha256_hex;

use crate::estimates::propeller::PropellerSeries;
use crate::estimates::regression::{Regression, RegressionValue};

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../../models/regressions");

/// File name of the propeller series.
const SERIES: &str = "wageningen-b.yaml";

/// Regressions by name, and the propeller series.
#[derive(Debug, Clone)]
pub struct RegressionLibrary {
    /// SHA-256 of all files, in the order of their names.
    pub sha256: String,
    /// Regressions in the order of their names.
    pub regressions: Vec<Regression>,
    pub(crate) series: PropellerSeries,
}

impl RegressionLibrary {
    /// Parses the embedded regressions.
    ///
    /// # Errors
    /// Returns the error of the first file that cannot be read; a test prevents this in a release.
    pub fn parse_embedded() -> Result<Self, FileError> {
        let files = FILES.files().filter_map(|file| {
            let name = file.path().to_str().filter(|name| name.ends_with(".yaml"))?;
            Some((name, file.contents_utf8()?))
        });
        let mut files: Vec<(&str, &str)> = files.collect();
        // Sorted, so that the hash does not depend on the order of the embedded directory.
        files.sort_unstable();
        let texts: Vec<u8> = files.iter().flat_map(|(_, text)| text.bytes()).collect();
        let files = files.into_iter();
        let (series, others): (Vec<_>, Vec<_>) = files.partition(|(name, _)| *name == SERIES);
        let parsed: Vec<Result<Regression, FileError>> =
            others.into_par_iter().map(|(name, text)| Regression::parse(name, text)).collect();
        let mut regressions = parsed.into_iter().collect::<Result<Vec<_>, _>>()?;
        regressions.sort_by(|a, b| a.name.cmp(&b.name));
        let series = series.first().map(|(name, text)| PropellerSeries::parse(name, text));
        let missing = || FileError {
            file: SERIES.to_owned(),
            line: None,
            field: String::new(),
            message: "is missing".to_owned(),
            further: Vec::new(),
        };
        Ok(Self { sha256: sha256_hex(&texts), regressions, series: series.ok_or_else(missing)?? })
    }

    /// Values of all regressions for a name.
    pub fn regression_values(
        &self,
        name: &str,
        known: &dyn Fn(&str) -> Option<f64>,
    ) -> Vec<RegressionValue> {
        self.regressions.iter().filter_map(|one| one.value_for(name, known)).collect()
    }
}
