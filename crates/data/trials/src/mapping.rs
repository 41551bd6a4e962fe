//! What is known of a file before it is opened.

use sistership_model::manifest::{ColumnMapping, Manifest, ManifestTrial, TrialConventions};

use crate::declarations::{Declarations, SensorFile};
use crate::exclusion::Exclusion;
use crate::limits::Limits;
use crate::stretches::Stretch;

/// Which columns are which channels, in which signs, and how large the file may be.
///
/// Columns that carry canonical names (with any unit suffix) need no entry.
#[derive(Debug, Clone, Default)]
pub struct Mapping {
    /// Channel name (or `t`) and where it stands.
    pub columns: Vec<(String, ColumnMapping)>,
    /// Signs and frames.
    pub conventions: TrialConventions,
    /// What was sailed.
    pub manoeuvre: Option<String>,
    /// Water depth where it is constant, m.
    pub depth_m: Option<f64>,
    /// What else is declared of the file.
    pub declared: Declarations,
    /// The stretch of the file that is read; absent for the whole.
    pub stretch: Option<Stretch>,
    /// Bounds on the file.
    pub limits: Limits,
    /// Rows that room is made for before any is read, so that columns need not grow; see
    /// [`crate::demand`].
    pub room: usize,
    /// What is left out of the file, as faulty.
    pub exclude: Vec<Exclusion>,
    /// Where columns are yet to be identified: the place and unit of a time that is written as
    /// text. Every column is then read as it stands.
    pub(crate) unidentified: Option<WrittenTime>,
    /// Whether faults are looked for.
    pub(crate) seeks_faults: bool,
}

/// A column of times that are written as text, if there is one: its place and unit.
#[derive(Debug, Clone, Default)]
pub(crate) struct WrittenTime(pub Option<(usize, &'static str)>);

impl Mapping {
    /// The mapping of a file whose columns have canonical names and whose signs are the canonical
    /// ones.
    pub fn canonical() -> Self {
        Self::default()
    }

    /// The mapping of one file of a manifest.
    pub fn of(manifest: &Manifest, trial: &ManifestTrial) -> Self {
        Self {
            columns: match trial.columns.is_empty() {
                true => &manifest.columns,
                false => &trial.columns,
            }
            .iter()
            .map(|(name, column)| (name.clone(), column.clone()))
            .collect(),
            conventions: manifest.conventions.clone(),
            manoeuvre: trial.manoeuvre.clone(),
            depth_m: trial.depth_m,
            declared: Declarations::default(),
            stretch: Stretch::of(trial),
            limits: Limits::default(),
            room: 0,
            exclude: Vec::new(),
            unidentified: None,
            seeks_faults: false,
        }
    }

    /// The mapping of a sensor's file that belongs to this one.
    pub(crate) fn of_sensor(&self, sensor: &SensorFile) -> Self {
        let columns = sensor.columns.iter();
        Self {
            columns: columns.map(|(name, column)| (name.clone(), column.clone())).collect(),
            room: 0,
            stretch: None,
            exclude: Vec::new(),
            ..self.clone()
        }
    }
}
