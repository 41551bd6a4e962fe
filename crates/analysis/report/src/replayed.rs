//! Plotted trials, with the simulations by two models.

use std::collections::BTreeMap;

use crate::plots::HullOutline;
use serde::Serialize;
use sistership_model::trial::Trial;
use sistership_simulation::recorded::TrialReplay;

/// Summary of the plots of one trial.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ReplaySummary<'a> {
    pub trial: &'a str,
    pub manoeuvre: Option<&'a str>,
    pub duration_s: f64,
    /// True if the refined model was fitted to this trial.
    pub fitted: bool,
    /// Root mean squared errors of the source from start to end without restart, SI units.
    pub source: BTreeMap<String, f64>,
    /// The same for the refined model.
    pub refined: BTreeMap<String, f64>,
    pub source_stopped: Option<String>,
    pub refined_stopped: Option<String>,
}

/// Trial with both simulations.
#[derive(Debug)]
pub(crate) struct ReplayedTrial<'a> {
    pub trial: &'a Trial,
    pub source: TrialReplay,
    pub refined: TrialReplay,
    /// True if roll is simulated.
    pub rolls: bool,
    /// Outline of the ship, if length and beam are known.
    pub hull: Option<HullOutline>,
    pub shown: ReplaySummary<'a>,
}
