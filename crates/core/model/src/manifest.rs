//! The manifest that maps a file to trials: columns, units, signs and frames.

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
    /// The ship that was tried; it may be left open, as `refine --ship` names it.
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

/// Where a channel stands in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnMapping {
    /// The column's header.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// Whether it counts the other way than the channel: heading anticlockwise, `v` to port. Of
    /// rudders `rudder_positive` says so for all files.
    #[serde(default, skip_serializing_if = "is_false")]
    pub reversed: bool,
}

impl ColumnMapping {
    /// A column that counts as the channel does.
    pub fn new(column: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { column: column.into(), unit: unit.into(), reversed: false }
    }
}

fn is_false(value: &bool) -> bool {
    !value
}

/// One file of a manifest, or a stretch of one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManifestTrial {
    /// Path, relative to the manifest.
    pub file: String,
    /// Where the stretch begins that is read; absent for the file's first row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<FileTime>,
    /// Where it ends; absent for the last row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<FileTime>,
    /// What was sailed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manoeuvre: Option<String>,
    /// Water depth, m; absent for deep water.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_m: Option<f64>,
    /// The file's own columns, in place of those of the manifest.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, ColumnMapping>")]
    pub columns: IndexMap<String, ColumnMapping>,
}

impl ManifestTrial {
    /// A file by its name alone.
    pub fn of(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            from: None,
            to: None,
            manoeuvre: None,
            depth_m: None,
            columns: IndexMap::new(),
        }
    }

    /// Whether only a part of the file is read.
    pub fn is_stretch(&self) -> bool {
        self.from.is_some() || self.to.is_some()
    }

    /// What the trial is called: its file, with the times of a stretch as media fragments have them
    /// (W3C 2012), `log.csv#t=3600,5400`.
    pub fn label(&self) -> String {
        let text = |time: &Option<FileTime>| time.as_ref().map_or(String::new(), |t| t.to_string());
        match self.is_stretch() {
            true => format!("{}#t={},{}", self.file, text(&self.from), text(&self.to)),
            false => self.file.clone(),
        }
    }
}

/// A time of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FileTime {
    /// As in its column of seconds; where that has dates or times of day, s since its first row.
    Seconds(f64),
    /// As a clock says it, such as `2024-05-01T09:30:00Z` or `09:30:00`.
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
    /// Which way positive rudder turns the ship.
    pub rudder_positive: RudderSign,
    /// What columns of `u` and `v` are speeds over or through; those of `u_water` and `v_water`
    /// are through the water always.
    pub velocity: VelocityFrame,
    /// How wind is given.
    pub wind: WindConvention,
    /// What to do with rows in which a mapped value is missing or not a number.
    pub missing: Missing,
    /// Longest gap that `missing: bridge` fills, s; 4 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bridge_s: Option<f64>,
    /// Smooth the recorded channels at the door.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothing>,
}

/// Which way positive rudder turns the ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RudderSign {
    /// To starboard: the canonical sign.
    #[default]
    StarboardTurn,
    /// To port.
    PortTurn,
}

/// What `u` and `v` are components of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VelocityFrame {
    /// Ship-fixed components of the speed over the ground.
    #[default]
    Ground,
    /// Ship-fixed components of the speed through the water.
    Water,
}

/// How wind is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct WindConvention {
    /// True or apparent.
    pub kind: WindKind,
    /// Where it comes from or goes to.
    pub direction: WindDirection,
}

/// True or apparent wind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WindKind {
    /// Over the ground, clockwise from north.
    #[default]
    True,
    /// As felt aboard, clockwise from the bow.
    Apparent,
}

/// What a wind direction points at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WindDirection {
    /// Where the wind comes from.
    #[default]
    From,
    /// Where it blows to.
    To,
}

/// What to do with rows in which a value is missing or not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Missing {
    /// Refuse the file and name the row.
    #[default]
    Refuse,
    /// Leave the row out; the gap is kept as a warning and nothing is interpolated over it.
    Drop,
    /// Fill a channel's gap of at most `bridge_s` along the straight line between its ends, and
    /// leave the rows of longer gaps out; both are told.
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
