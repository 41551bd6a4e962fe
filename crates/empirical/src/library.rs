//! The regressions that the program carries.

use include_dir::{Dir, include_dir};
use sistership_model::FileError;

use crate::propeller::PropellerSeries;
use crate::regression::{Given, Regression};

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../models/regressions");

/// What the propeller series is called.
const SERIES: &str = "wageningen-b.yaml";

/// Regressions by name, and the propeller series.
#[derive(Debug, Clone)]
pub struct Library {
    /// In the order of their names.
    pub regressions: Vec<Regression>,
    pub(crate) series: PropellerSeries,
}

impl Library {
    /// The embedded ones.
    ///
    /// # Errors
    /// The first file that does not read; a test keeps this from happening in a release.
    pub fn embedded() -> Result<Self, FileError> {
        let mut regressions = Vec::new();
        let mut series = None;
        for file in FILES.files() {
            let name = file.path().to_str().unwrap_or_default();
            let text = file.contents_utf8().unwrap_or_default();
            if name == SERIES {
                series = Some(PropellerSeries::parse(name, text)?);
            } else if name.ends_with(".yaml") {
                regressions.push(Regression::parse(name, text)?);
            }
        }
        regressions.sort_by(|a, b| a.name.cmp(&b.name));
        let missing = || FileError {
            file: SERIES.to_owned(),
            line: None,
            field: String::new(),
            message: "is missing".to_owned(),
        };
        Ok(Self { regressions, series: series.ok_or_else(missing)? })
    }

    /// What every regression gives for a name.
    pub fn given(&self, name: &str, known: &dyn Fn(&str) -> Option<f64>) -> Vec<Given> {
        self.regressions.iter().filter_map(|one| one.given(name, known)).collect()
    }
}
