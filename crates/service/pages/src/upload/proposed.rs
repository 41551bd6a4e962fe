//! The proposed reading of an upload.

use std::collections::BTreeSet;

use indexmap::IndexMap;
use sistership_model::manifest::ColumnMapping;
use sistership_trials::{ColumnGuess, Derivable, Exclusion, ManifestFile};

/// Channels that a column may be mapped to, as manifests name them.
pub(super) const TARGETS: [&str; 28] = [
    "t",
    "x",
    "y",
    "latitude",
    "longitude",
    "psi",
    "u",
    "v",
    "u_water",
    "v_water",
    "r",
    "phi",
    "p",
    "delta",
    "delta_s",
    "delta_p",
    "n",
    "n_s",
    "n_p",
    "course",
    "speed",
    "v_north",
    "v_east",
    "wind_speed",
    "wind_from",
    "apparent_wind_speed",
    "apparent_wind_from",
    "depth",
];
/// Reason of what the form gives.
pub(super) const GIVEN: &str = "given on this page";
/// Velocities that can be derived, by the name of their field.
pub(super) const DERIVED: [(&str, Derivable); 3] =
    [("u", Derivable::U), ("v", Derivable::V), ("r", Derivable::R)];

/// An upload whose files have arrived.
#[derive(Debug, Clone)]
pub struct UploadProposal {
    /// The ship.
    pub ship: String,
    /// Id of the upload in addresses.
    pub id: String,
    /// Reading of each column, with its reason.
    pub guesses: Vec<ColumnGuess>,
    /// Manifest by which the files are read now.
    pub manifest: ManifestFile,
    /// True if the champion is to be diagnosed on the stored trials.
    pub diagnose: bool,
    /// Name of the template by which the columns are read.
    pub template: Option<String>,
}

impl UploadProposal {
    /// Returns the files whose columns the page maps: the first trial, which the other trials share,
    /// one for each other mapping of trials, and those of further sensors.
    pub(super) fn mapped_files(&self) -> Vec<&str> {
        let mut known: Vec<&IndexMap<String, ColumnMapping>> = Vec::new();
        let trials = self.manifest.manifest.trials.iter().filter(|trial| {
            let is_new = !known.contains(&&trial.columns);
            known.push(&trial.columns);
            is_new
        });
        let trials: Vec<&str> = trials.map(|trial| trial.file.as_str()).collect();
        let sensors = self.manifest.sensors.iter().flatten().map(|sensor| sensor.file.as_str());
        trials.into_iter().chain(sensors).collect()
    }

    /// Returns the columns of a file as they are mapped now.
    pub(super) fn mapped_columns(&self, file: &str) -> Vec<(&str, &ColumnMapping)> {
        let ManifestFile { manifest, sensors, .. } = &self.manifest;
        if let Some(sensor) = sensors.iter().flatten().find(|sensor| sensor.file == file) {
            return sensor.columns.iter().map(|(name, column)| (name.as_str(), column)).collect();
        }
        let own = manifest.trials.iter().find(|trial| trial.file == file);
        let own = own.map(|trial| &trial.columns).filter(|columns| !columns.is_empty());
        let columns = own.unwrap_or(&manifest.columns);
        columns.iter().map(|(name, column)| (name.as_str(), column)).collect()
    }

    /// Returns the channels that are read, without time.
    pub(super) fn channel_names(&self) -> Vec<&str> {
        let all = self.all_mappings().into_iter().map(|(_, name, _)| name);
        all.filter(|name| *name != "t").collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// Returns every mapping of a channel, with the file that stands for it.
    fn all_mappings(&self) -> Vec<(&str, &str, &ColumnMapping)> {
        let files = self.mapped_files().into_iter();
        let of_file = |file| {
            let columns = self.mapped_columns(file).into_iter();
            columns.map(move |(name, column)| (file, name, column))
        };
        files.flat_map(of_file).collect()
    }

    /// Returns the channels that another proposal for the same files reads otherwise.
    pub fn changed_channels(&self, other: &Self) -> BTreeSet<String> {
        let (own, others) = (self.all_mappings(), other.all_mappings());
        let changed = own.iter().filter(|one| !others.contains(one));
        let further = others.iter().filter(|one| !own.contains(one));
        changed.chain(further).map(|(_, name, _)| (*name).to_owned()).collect()
    }

    /// Replaces the exclusions of channels that are read otherwise now by faults that were found
    /// anew.
    pub fn renew_exclusions(&mut self, changed: &BTreeSet<String>, found: Vec<Exclusion>) {
        // Without a channel whole rows are excluded: times that decrease.
        let is_changed = |one: &Exclusion| changed.contains(one.channel.as_deref().unwrap_or("t"));
        let exclude = &mut self.manifest.declarations.exclude;
        exclude.retain(|one| !is_changed(one));
        exclude.extend(found.into_iter().filter(is_changed));
    }
}
