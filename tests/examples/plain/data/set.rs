//! One data set.

use std::collections::BTreeMap;
use std::path::PathBuf;

use sistership_model::Zoo;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::error::standard_deviations;

/// A ship with trials in files for the calls, and others that no call sees.
pub struct DataSet {
    /// What `--ship` is given.
    pub ship: String,
    /// The manifest that `--trials` is given.
    pub trials: PathBuf,
    /// Those trials as read.
    pub seen: Vec<Trial>,
    /// Trials that no call sees.
    pub unseen: Vec<Trial>,
    /// Simulations of them start anew every so often, s.
    pub restart_s: f64,
    /// By which errors are standardised.
    pub deviations: BTreeMap<Channel, f64>,
    /// Laws and models of the program.
    pub zoo: Zoo,
    /// Keeps the files.
    folder: tempfile::TempDir,
}

impl DataSet {
    /// Judged by the deviations of the unseen trials.
    pub fn new(
        ship: String,
        (trials, folder): (PathBuf, tempfile::TempDir),
        (seen, unseen): (Vec<Trial>, Vec<Trial>),
        restart_s: f64,
    ) -> Self {
        let deviations = standard_deviations(&unseen.iter().collect::<Vec<_>>());
        let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
        Self { ship, trials, seen, unseen, restart_s, deviations, zoo, folder }
    }

    /// Where the files lie.
    pub fn folder(&self) -> &std::path::Path {
        self.folder.path()
    }

    /// Whether a model's name, or a line that begins with it, is of the very ship that the data are
    /// of.
    pub fn is_own(&self, model: &str) -> bool {
        let name = model.split(' ').next().unwrap_or_default();
        // A law without coefficients has the ship's name, too, where the trials alone make the
        // model.
        name.split('/').next() == Some(self.ship.as_str()) && self.zoo.find_model(name).is_ok()
    }
}
