//! Knowledge of a file before it is opened.

use sistership_model::manifest::{
    ColumnMapping, Manifest, ManifestTrial, TrialConventions, split_part,
};

use crate::currents::TrialCurrent;
use crate::declarations::{Declarations, SensorFile};
use crate::exclusion::Exclusion;
use crate::file_segments::FileSegment;
use crate::limits::FileLimits;

/// Mapping of columns to channels, with signs and limits on the size of the file.
///
/// Columns with canonical names (with any unit suffix) need no entry.
#[derive(Debug, Clone, Default)]
pub struct Mapping {
    /// Channel name (or `t`) and its column.
    pub columns: Vec<(String, ColumnMapping)>,
    /// Signs and frames.
    pub conventions: TrialConventions,
    /// Manoeuvre of the trial.
    pub manoeuvre: Option<String>,
    /// Water depth where it is constant, m.
    pub depth_m: Option<f64>,
    /// Revolutions held throughout where they were not recorded, 1/s.
    pub n_rps: Option<f64>,
    /// Sheet of a workbook, by default the one with most known names; structure of a MATLAB file, or
    /// group of an HDF5 file.
    pub part: Option<String>,
    /// Further declarations on the file.
    pub declared: Declarations,
    /// Segment of the file that is read; `None` for the whole file.
    pub stretch: Option<FileSegment>,
    /// Limits on the size of the file.
    pub limits: FileLimits,
    /// Number of rows for which memory is reserved, so that columns need not grow; see
    /// [`crate::demand`].
    pub room: usize,
    /// Values and rows that are excluded as faulty.
    pub exclude: Vec<Exclusion>,
    /// Current of the trial, which is subtracted.
    pub current: Option<TrialCurrent>,
    /// For columns that are yet to be identified: index and unit of a time that is written as text.
    /// Every column is then read as it is.
    pub(crate) unidentified: Option<WrittenTime>,
    /// Search for faults of the values.
    pub(crate) faults: FaultHandling,
}

/// Handling of faults of the values of a file that its mapping does not exclude.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum FaultHandling {
    /// Faults are not searched.
    #[default]
    Ignore,
    /// Faults are reported, and the values stay.
    Report,
    /// Faults are reported, and their values are excluded.
    Exclude,
}

/// Column of times written as text, if there is one: its index and unit.
#[derive(Debug, Clone, Default)]
pub(crate) struct WrittenTime(pub Option<(usize, &'static str)>);

impl Mapping {
    /// Returns the mapping of a file with canonical column names and signs.
    pub fn with_canonical_names() -> Self {
        Self::default()
    }

    /// Returns the mapping of one file of a manifest.
    pub fn from_manifest(manifest: &Manifest, trial: &ManifestTrial) -> Self {
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
            n_rps: trial.n_rps,
            part: split_part(&trial.file).1.map(str::to_owned),
            declared: Declarations::default(),
            stretch: FileSegment::from_trial(trial),
            limits: FileLimits::default(),
            room: 0,
            exclude: Vec::new(),
            current: None,
            unidentified: None,
            faults: FaultHandling::Ignore,
        }
    }

    /// Returns the mapping of the file of a sensor that belongs to this file.
    pub(crate) fn for_sensor(&self, sensor: &SensorFile) -> Self {
        let columns = sensor.columns.iter();
        Self {
            columns: columns.map(|(name, column)| (name.clone(), column.clone())).collect(),
            part: split_part(&sensor.file).1.map(str::to_owned),
            room: 0,
            stretch: None,
            exclude: Vec::new(),
            ..self.clone()
        }
    }
}
