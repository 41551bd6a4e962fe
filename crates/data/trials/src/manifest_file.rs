//! A manifest as it is written: what the model's type holds, and what the reader is told besides.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::manifest::{
    ColumnMapping, FileTime, Manifest, ManifestTrial, TrialConventions, TrialsKind,
};

use crate::declarations::{Antenna, Declarations, Derivable, Maximum, North, SensorFile};
use crate::mapping::Mapping;

/// A manifest with everything that it declares.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(into = "Written")]
pub struct ManifestFile {
    /// Columns, conventions and files.
    pub manifest: Manifest,
    /// What else is declared of all files.
    pub declarations: Declarations,
    /// For each trial, the further files that belong to it.
    pub sensors: Vec<Vec<SensorFile>>,
}

/// The keys of the file. `Manifest` refuses what it does not know, so that its fields stand here
/// once more.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Written {
    kind: TrialsKind,
    ship: String,
    #[serde(default)]
    conventions: TrialConventions,
    #[serde(default, skip_serializing_if = "is_default")]
    heading: North,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    variation_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    maximum: BTreeMap<String, Maximum>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    antenna: Option<Antenna>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    derive: Vec<Derivable>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sheet: Option<String>,
    #[serde(default)]
    columns: indexmap::IndexMap<String, ColumnMapping>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    ignore: Vec<String>,
    trials: Vec<WrittenTrial>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenTrial {
    file: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    from: Option<FileTime>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    to: Option<FileTime>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    manoeuvre: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    depth_m: Option<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    sensors: Vec<SensorFile>,
}

fn is_default(north: &North) -> bool {
    *north == North::default()
}

impl ManifestFile {
    /// The mapping of one of its files.
    pub fn mapping(&self, trial: &ManifestTrial) -> Mapping {
        Mapping { declared: self.declarations.clone(), ..Mapping::of(&self.manifest, trial) }
    }

    /// What it says of one of its trials.
    pub fn only(&self, index: usize) -> Self {
        // Field by field: the other trials are not copied, of which an upload may have hundreds.
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

    /// The text of the file.
    ///
    /// # Errors
    /// None that is known: its content is plain text and numbers.
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
            sheet: written.sheet,
            heading: written.heading,
            variation_deg: written.variation_deg,
            maximum: written.maximum,
            antenna: written.antenna,
            derive: written.derive,
        };
        Self { manifest, declarations, sensors }
    }
}

impl From<ManifestFile> for Written {
    fn from(file: ManifestFile) -> Self {
        let ManifestFile { manifest, declarations, sensors } = file;
        let sensors = sensors.into_iter().chain(std::iter::repeat(Vec::new()));
        let trials = manifest.trials.into_iter().zip(sensors).map(|(trial, sensors)| {
            let ManifestTrial { file, from, to, manoeuvre, depth_m } = trial;
            WrittenTrial { file, from, to, manoeuvre, depth_m, sensors }
        });
        Self {
            kind: manifest.kind,
            ship: manifest.ship,
            conventions: manifest.conventions,
            heading: declarations.heading,
            variation_deg: declarations.variation_deg,
            maximum: declarations.maximum,
            antenna: declarations.antenna,
            derive: declarations.derive,
            sheet: declarations.sheet,
            columns: manifest.columns,
            ignore: declarations.ignore,
            trials: trials.collect(),
        }
    }
}
