//! A trial that is plotted, with the simulations by two models.

use std::collections::BTreeMap;

use crate::plots::Hull;
use serde::Serialize;
use sistership_model::trial::Trial;
use sistership_simulation::recorded::Replay;

/// What the plots of one trial show.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ReplaySummary<'a> {
    pub trial: &'a str,
    pub manoeuvre: Option<&'a str>,
    pub duration_s: f64,
    /// Whether the refined model was fitted with this trial.
    pub fitted: bool,
    /// Root mean square errors from start to end without a restart, SI.
    pub source: BTreeMap<String, f64>,
    /// The same of the refined model.
    pub refined: BTreeMap<String, f64>,
    pub source_stopped: Option<String>,
    pub refined_stopped: Option<String>,
}

/// A trial with both simulations.
#[derive(Debug)]
pub(crate) struct ReplayedTrial<'a> {
    pub trial: &'a Trial,
    pub source: Replay,
    pub refined: Replay,
    /// Whether roll is part of the simulation.
    pub rolls: bool,
    /// The ship that sailed it, where length and beam are known.
    pub hull: Option<Hull>,
    pub shown: ReplaySummary<'a>,
}
