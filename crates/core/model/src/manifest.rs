//! Manifest that maps files to trials: columns, units, signs and frames.

use std::collections::BTreeMap;
use std::fmt;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A trial manifest: which columns of which files are which channels, in which units and signs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Always `trials`.
    pub kind: TrialsKind,
    /// The ship of the trials; may be absent, since `refine --ship` also names it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub ship: String,
    /// Signs and frames of the files.
    #[serde(default)]
    pub conventions: TrialConventions,
    /// Channel (`t`, `x`, `psi`, ...) to column; canonical column names need no mapping.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, ColumnMapping>")]
    pub columns: IndexMap<String, ColumnMapping>,
    /// The files, relative to the manifest.
    pub trials: Vec<ManifestTrial>,
}

/// The word `trials`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TrialsKind {
    /// The only one.
    Trials,
}

/// The column of a channel in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnMapping {
    /// The column's header.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// True if it has the opposite sign of the channel: heading anticlockwise, `v` to port. For
    /// rudders, `rudder_positive` declares the sign for all files.
    #[serde(default, skip_serializing_if = "is_false")]
    pub reversed: bool,
}

impl ColumnMapping {
    /// Creates a mapping for a column with the sign of the channel.
    pub fn new(column: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { column: column.into(), unit: unit.into(), reversed: false }
    }
}

fn is_false(value: &bool) -> bool {
    !value
}

/// One file of a manifest, or a segment of one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManifestTrial {
    /// Path, relative to the manifest; `log.xlsx#part=NAME` for a sheet of a workbook, a structure of a
    /// MATLAB file or a group of an HDF5 file.
    pub file: String,
    /// Start of the segment to read; default: the file's first row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<FileTime>,
    /// End of the segment; default: the last row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<FileTime>,
    /// The manoeuvre, such as `zigzag 10/10`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manoeuvre: Option<String>,
    /// Water depth, m; absent for deep water.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_m: Option<f64>,
    /// Propeller revolutions, 1/s, held throughout the trial, where they were not recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub n_rps: Option<f64>,
    /// Columns of this file, in place of those of the manifest.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, ColumnMapping>")]
    pub columns: IndexMap<String, ColumnMapping>,
}

impl ManifestTrial {
    /// Creates an entry for a whole file.
    pub fn from_file_name(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            from: None,
            to: None,
            manoeuvre: None,
            depth_m: None,
            n_rps: None,
            columns: IndexMap::new(),
        }
    }

    /// Returns true if only a part of the file is read.
    pub fn is_segment(&self) -> bool {
        self.from.is_some() || self.to.is_some()
    }

    /// Name of the trial: its file, with the times of a segment in the notation of media fragments
    /// (W3C 2012), `log.csv#t=3600,5400`.
    pub fn trial_label(&self) -> String {
        let text = |time: &Option<FileTime>| time.as_ref().map_or(String::new(), |t| t.to_string());
        let mark = if split_part(&self.file).1.is_some() { '&' } else { '#' };
        match self.is_segment() {
            true => format!("{}{mark}t={},{}", self.file, text(&self.from), text(&self.to)),
            false => self.file.clone(),
        }
    }

    /// Returns the path of the file itself.
    pub fn file_path(&self) -> &str {
        split_part(&self.file).0
    }
}

/// Separates a file from its part, a sheet of a workbook, a structure or a group:
/// `log.xlsx#part=NAME`.
pub fn split_part(file: &str) -> (&str, Option<&str>) {
    match file.split_once("#part=") {
        Some((path, part)) => (path, Some(part)),
        None => (file, None),
    }
}

/// A time of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FileTime {
    /// As in its column of seconds; for a column of dates or times of day, s since its first row.
    Seconds(f64),
    /// Clock time, such as `2024-05-01T09:30:00Z` or `09:30:00`.
    Clock(String),
}

impl fmt::Display for FileTime {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seconds(seconds) => write!(out, "{seconds}"),
            Self::Clock(text) => out.write_str(text),
        }
    }
}

/// Signs and frames of a file; the defaults are the canonical ones.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TrialConventions {
    /// Direction in which positive rudder turns the ship.
    pub rudder_positive: RudderSign,
    /// Frame of the velocities in columns of `u` and `v`; those of `u_water` and `v_water` are
    /// always through the water.
    pub velocity: VelocityFrame,
    /// Convention of the wind.
    pub wind: WindConvention,
    /// Treatment of rows in which a mapped value is missing or not a number.
    pub missing: MissingValues,
    /// Longest gap that `missing: bridge` fills, s; 4 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bridge_s: Option<f64>,
    /// Smoothing of the recorded channels on input.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

/// Direction in which positive rudder turns the ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RudderSign {
    /// To starboard: the canonical sign.
    #[default]
    StarboardTurn,
    /// To port.
    PortTurn,
}

/// Frame of the velocities `u` and `v`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VelocityFrame {
    /// Ship-fixed components of the speed over the ground.
    #[default]
    Ground,
    /// Ship-fixed components of the speed through the water.
    Water,
}

/// Convention of the wind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct WindConvention {
    /// True or apparent.
    pub kind: WindKind,
    /// Meaning of the direction.
    pub direction: WindDirection,
}

/// True or apparent wind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WindKind {
    /// Over the ground, clockwise from north.
    #[default]
    True,
    /// As measured aboard, clockwise from the bow.
    Apparent,
}

/// Meaning of a wind direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WindDirection {
    /// The wind comes from there.
    #[default]
    From,
    /// The wind blows to there.
    To,
}

/// Treatment of rows in which a value is missing or not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MissingValues {
    /// Refuse the file and name the row.
    #[default]
    Refuse,
    /// Leave the row out; the gap is reported as a warning, and nothing is interpolated over it.
    Drop,
    /// Fill a channel's gap of at most `bridge_s` by linear interpolation, and leave the rows of
    /// longer gaps out; both are reported.
    Bridge,
}

/// Savitzky-Golay smoothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Smoothing {
    /// Odd number of samples in the window.
    pub window: usize,
    /// Degree of the polynomial, less than the window.
    pub degree: usize,
}
