//! What a manifest declares of its files beyond columns, signs and frames.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_model::manifest::ColumnMapping;

use crate::exclusion::Exclusion;

/// Everything that the reader cannot know of a file unless it is declared.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Declarations {
    /// Columns that are not wanted, and not listed as left out.
    pub ignore: Vec<String>,
    /// The sheet of a workbook; absent for the first that has a table.
    pub sheet: Option<String>,
    /// Which north headings and courses are counted from.
    pub heading: North,
    /// Magnetic variation, deg, positive to the east: what is added to a magnetic heading.
    pub variation_deg: Option<f64>,
    /// What 100 % of a channel is.
    pub maximum: BTreeMap<String, Maximum>,
    /// Where positions were measured aboard.
    pub antenna: Option<Antenna>,
    /// Channels to be derived of position and heading where they were not measured: `u`, `v`, `r`.
    pub derive: Vec<Derivable>,
    /// What is left out of files as faulty.
    pub exclude: Vec<Exclusion>,
}

/// Which north a heading is counted from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum North {
    /// The geographic one.
    #[default]
    True,
    /// The one that a magnetic compass shows.
    Magnetic,
}

/// A full value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Maximum {
    /// How much.
    pub value: f64,
    /// In which unit.
    pub unit: String,
}

/// Where an antenna stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Antenna {
    /// Forward of midship, m.
    pub x_m: f64,
    /// To starboard of the centre line, m.
    pub y_m: f64,
}

/// A channel that can be derived of others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Derivable {
    /// Surge velocity, of positions and heading.
    U,
    /// Sway velocity, of positions and heading.
    V,
    /// Yaw rate, of the heading.
    R,
}

/// A file of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorFile {
    /// Path, relative to the manifest.
    pub file: String,
    /// Its columns, as of the manifest.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub columns: BTreeMap<String, ColumnMapping>,
    /// What is added to its time to have that of the trial's first file, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock_offset_s: Option<f64>,
}
