//! Manifest in its written form: the manifest of the model, and the declarations for the reader.

use std::borrow::Cow;
use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sistership_model::manifest::{
    ColumnMapping, FileTime, Manifest, ManifestTrial, TrialConventions, TrialsKind,
};

use crate::currents::TrialCurrent;
use crate::declarations::{
    Antenna, Declarations, Derivable, GeographicPosition, Maximum, North, SensorFile,
};
use crate::exclusion::Exclusion;
use crate::mapping::Mapping;

/// Manifest with all its declarations.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "Written")]
pub struct ManifestFile {
    /// Columns, conventions and files.
    pub manifest: Manifest,
    /// Further declarations on all files.
    pub declarations: Declarations,
    /// For each trial, the further files that belong to it.
    pub sensors: Vec<Vec<SensorFile>>,
}

/// Trials of a ship: files, columns, signs, and data excluded as faulty.
// `Manifest` refuses unknown fields and cannot be flattened, so that its fields are repeated here.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Written {
    /// Always `trials`.
    kind: TrialsKind,
    /// Ship of the trials; optional, as `refine --ship` can name it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    ship: String,
    /// Signs and frames of the files.
    #[serde(default)]
    conventions: TrialConventions,
    /// North reference of headings and courses.
    #[serde(default, skip_serializing_if = "is_default")]
    heading: North,
    /// Magnetic variation, deg, positive to the east; it is added to a magnetic heading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    variation_deg: Option<f64>,
    /// Value of a channel at 100 %.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    maximum: BTreeMap<String, Maximum>,
    /// Position of the antenna on board.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    antenna: Option<Antenna>,
    /// Geographic position of the origin of `x` and `y`; by default the first fix. It places trials
    /// on the map, and changes no sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    origin: Option<GeographicPosition>,
    /// Channels to be derived from position and heading where they were not measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    derive: Vec<Derivable>,
    /// Channel (`t`, `x`, `psi`, ...) to column; canonical column names need no mapping. `#3` is
    /// the third column of a file without a header.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, ColumnMapping>")]
    columns: indexmap::IndexMap<String, ColumnMapping>,
    /// Columns that are not needed, and not reported as unused.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    ignore: Vec<String>,
    /// Values and rows that are excluded as faulty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    exclude: Vec<Exclusion>,
    /// Currents of trials, which are subtracted from velocities over the ground and positions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    currents: Vec<TrialCurrent>,
    /// Files, relative to the manifest.
    trials: Vec<WrittenTrial>,
}

/// A file, or a segment of one.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct WrittenTrial {
    /// Path, relative to the manifest; `log.xlsx#part=NAME` for a sheet of a workbook, a structure of a
    /// MATLAB file or a group of an HDF5 file.
    file: String,
    /// Start of the segment that is read; by default the first row of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    from: Option<FileTime>,
    /// End of the segment; by default the last row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    to: Option<FileTime>,
    /// Name of the manoeuvre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    manoeuvre: Option<String>,
    /// Water depth, m; by default deep water.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    depth_m: Option<f64>,
    /// Propeller revolutions, 1/s, held throughout the trial, where they were not recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    n_rps: Option<f64>,
    /// Columns of this file, instead of those of the manifest.
    #[serde(default, skip_serializing_if = "indexmap::IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, ColumnMapping>")]
    columns: indexmap::IndexMap<String, ColumnMapping>,
    /// Files of further sensors, which are interpolated to the times of the trial.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    sensors: Vec<SensorFile>,
}

fn is_default(north: &North) -> bool {
    *north == North::default()
}

impl JsonSchema for ManifestFile {
    fn schema_name() -> Cow<'static, str> {
        "Manifest".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Written::json_schema(generator)
    }
}

impl ManifestFile {
    /// Returns the mapping of one file of the manifest.
    pub fn trial_mapping(&self, trial: &ManifestTrial) -> Mapping {
        let of_file = self.declarations.exclude.iter().filter(|one| one.file == trial.file);
        Mapping {
            declared: self.declarations.clone(),
            exclude: of_file.cloned().collect(),
            current: self.current_of(trial).cloned(),
            ..Mapping::from_manifest(&self.manifest, trial)
        }
    }

    fn current_of(&self, trial: &ManifestTrial) -> Option<&TrialCurrent> {
        let label = trial.trial_label();
        self.declarations.currents.iter().find(|one| one.trial == label)
    }

    /// Returns the manifest reduced to one of its trials.
    pub fn only_trial(&self, index: usize) -> Self {
        // Field by field, so that the other trials are not copied: an upload may have hundreds.
        let Manifest { kind, ship, conventions, columns, trials } = &self.manifest;
        let manifest = Manifest {
            kind: *kind,
            ship: ship.clone(),
            conventions: conventions.clone(),
            columns: columns.clone(),
            trials: trials.get(index).cloned().into_iter().collect(),
        };
        Self {
            manifest,
            declarations: self.declarations.clone(),
            sensors: self.sensors.get(index).cloned().into_iter().collect(),
        }
    }

    /// Returns the text of the file.
    ///
    /// # Errors
    /// No error is known: the content is plain text and numbers.
    pub fn to_yaml(&self) -> Result<String, serde_yaml::Error> {
        serde_yaml::to_string(&Written::from(self.clone()))
    }
}

impl From<Manifest> for ManifestFile {
    fn from(manifest: Manifest) -> Self {
        let sensors = vec![Vec::new(); manifest.trials.len()];
        Self { manifest, declarations: Declarations::default(), sensors }
    }
}

impl From<Written> for ManifestFile {
    fn from(written: Written) -> Self {
        let sensors = written.trials.iter().map(|trial| trial.sensors.clone()).collect();
        let trials = written.trials.into_iter().map(|trial| ManifestTrial {
            file: trial.file,
            from: trial.from,
            to: trial.to,
            manoeuvre: trial.manoeuvre,
            depth_m: trial.depth_m,
            n_rps: trial.n_rps,
            columns: trial.columns,
        });
        let manifest = Manifest {
            kind: written.kind,
            ship: written.ship,
            conventions: written.conventions,
            columns: written.columns,
            trials: trials.collect(),
        };
        let declarations = Declarations {
            ignore: written.ignore,
            heading: written.heading,
            variation_deg: written.variation_deg,
            maximum: written.maximum,
            antenna: written.antenna,
            origin: written.origin,
            derive: written.derive,
            exclude: written.exclude,
            currents: written.currents,
        };
        Self { manifest, declarations, sensors }
    }
}

impl From<ManifestFile> for Written {
    fn from(file: ManifestFile) -> Self {
        let ManifestFile { manifest, declarations, sensors } = file;
        // The list of sensors may be shorter than that of trials.
        let sensors = sensors.into_iter().chain(std::iter::repeat(Vec::new()));
        let trials = manifest.trials.into_iter().zip(sensors).map(|(trial, sensors)| {
            let ManifestTrial { file, from, to, manoeuvre, depth_m, n_rps, columns } = trial;
            WrittenTrial { file, from, to, manoeuvre, depth_m, n_rps, columns, sensors }
        });
        Self {
            kind: manifest.kind,
            ship: manifest.ship,
            conventions: manifest.conventions,
            heading: declarations.heading,
            variation_deg: declarations.variation_deg,
            maximum: declarations.maximum,
            antenna: declarations.antenna,
            origin: declarations.origin,
            derive: declarations.derive,
            columns: manifest.columns,
            ignore: declarations.ignore,
            exclude: declarations.exclude,
            currents: declarations.currents,
            trials: trials.collect(),
        }
    }
}
