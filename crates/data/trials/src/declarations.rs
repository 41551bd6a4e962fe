//! Declarations of a manifest on its files, besides columns, signs and frames.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_model::manifest::{ColumnMapping, split_part};

use crate::currents::TrialCurrent;
use crate::exclusion::Exclusion;

/// Properties of a file that the reader cannot know unless they are declared.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Declarations {
    /// Columns that are not needed, and not reported as unused.
    pub ignore: Vec<String>,
    /// North reference of headings and courses.
    pub heading: North,
    /// Magnetic variation, deg, positive to the east; it is added to a magnetic heading.
    pub variation_deg: Option<f64>,
    /// Value of a channel at 100 %.
    pub maximum: BTreeMap<String, Maximum>,
    /// Position of the antenna on board.
    pub antenna: Option<Antenna>,
    /// Geographic position of the origin of `x` and `y`; by default the first fix.
    pub origin: Option<GeographicPosition>,
    /// Channels to be derived from position and heading where they were not measured: `u`, `v`,
    /// `r`.
    pub derive: Vec<Derivable>,
    /// Values and rows that are excluded as faulty.
    pub exclude: Vec<Exclusion>,
    /// Currents, which are subtracted.
    pub currents: Vec<TrialCurrent>,
}

/// North reference of a heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum North {
    /// Geographic north.
    #[default]
    True,
    /// North of a magnetic compass.
    Magnetic,
}

/// Value of a channel at 100 %.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Maximum {
    /// Value in the given unit.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
}

/// Position of an antenna on board.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Antenna {
    /// Distance forward of midship, m.
    pub x_m: f64,
    /// Distance to starboard of the centre line, m.
    pub y_m: f64,
}

/// Position on the ellipsoid WGS 84.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GeographicPosition {
    /// Latitude, deg, positive to the north.
    pub latitude_deg: f64,
    /// Longitude, deg, positive to the east, from -180 to 180.
    pub longitude_deg: f64,
}

impl GeographicPosition {
    /// Returns true if latitude and longitude are within their ranges.
    pub fn is_valid(&self) -> bool {
        self.latitude_deg.abs() <= 90.0 && self.longitude_deg.abs() <= 180.0
    }
}

/// Channel that can be derived from others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Derivable {
    /// Surge velocity, from positions and heading.
    U,
    /// Sway velocity, from positions and heading.
    V,
    /// Yaw rate, from the heading.
    R,
}

/// File of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorFile {
    /// Path, relative to the manifest; `log.xlsx#part=NAME` for a sheet of a workbook, a structure of a
    /// MATLAB file or a group of an HDF5 file.
    pub file: String,
    /// Columns of the file, as in the manifest.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub columns: BTreeMap<String, ColumnMapping>,
    /// Offset, s, added to the time of the sensor to obtain the time of the trial's first file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock_offset_s: Option<f64>,
}

impl SensorFile {
    /// Returns the path of the file itself.
    pub fn file_path(&self) -> &str {
        split_part(&self.file).0
    }
}
