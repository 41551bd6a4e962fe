//! Manoeuvres in addition to the standard ones: stopping, pull-outs, spirals.

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::law::Law;

use super::ManoeuvreSettings;
use super::pull_out::simulate_pull_out;
use super::spiral::simulate_spirals;
use super::stopping::{AsternOrder, StoppingError, simulate_stop};
use crate::metrics::{
    ImoCriterion, PullOutMetrics, SpiralMetrics, StoppingMetrics, TRACK_REACH_ALLOWED,
    is_straight_line_stable,
};
use crate::ship::Ship;
use crate::state::Trajectory;

/// Selection of the additional manoeuvres to simulate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FurtherSelection {
    /// A full astern stop.
    pub stop: Option<AsternOrder>,
    /// Pull-outs of turns with these rudder angles, deg.
    pub pull_outs_deg: Vec<f64>,
    /// Condition under which spirals are simulated.
    pub spiral: SpiralSelection,
}

/// Condition under which spirals are simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpiralSelection {
    /// Never.
    #[default]
    Never,
    /// If pull-outs do not show that the ship is stable on a straight course.
    WhereUnstable,
    /// Always.
    Always,
}

/// Rudder of the turns before pull-outs, deg: that of the simplified trials of MSC/Circ.1053,
/// appendix 4.
const PULL_OUT_DEG: f64 = 20.0;

impl FurtherSelection {
    /// Default selection: a stop, pull-outs to both sides, and spirals for a ship that is not
    /// stable on a straight course.
    pub fn default_selection() -> Self {
        Self {
            stop: Some(AsternOrder::default()),
            pull_outs_deg: vec![PULL_OUT_DEG, -PULL_OUT_DEG],
            spiral: SpiralSelection::WhereUnstable,
        }
    }
}

/// Metrics and tracks of the additional manoeuvres.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FurtherManoeuvres {
    /// The full astern stop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopping: Option<StoppingMetrics>,
    /// Reason for which there is no stopping test: the model does not cover a reversed propeller.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_stopping: Option<String>,
    /// Pull-outs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pull_outs: Vec<PullOutMetrics>,
    /// Straight-line stability, by pull-outs to both sides, or by spirals if these were simulated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub straight_line_stable: Option<bool>,
    /// Spirals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spiral: Option<SpiralMetrics>,
    /// Manoeuvres that left the physical range, with the reason.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<String>,
    /// Tracks of the stop and the pull-outs, by name.
    #[serde(skip)]
    pub tracks: Vec<(String, Trajectory)>,
}

impl FurtherManoeuvres {
    /// Criterion of stopping ability; `None` without a stopping test.
    pub fn stopping_criterion(&self, lpp_m: f64) -> Option<ImoCriterion> {
        Some(self.stopping.as_ref()?.track_reach_criterion(lpp_m))
    }

    /// Remarks that a reader of the figures needs.
    pub fn reader_remarks(&self, lpp_m: f64) -> Vec<String> {
        let mut remarks = Vec::new();
        if let Some(stop) = &self.stopping {
            let StoppingMetrics { astern_rps, reversal_s, .. } = stop;
            remarks.push(format!(
                "stopping: the revolutions change to {astern_rps:.4} 1/s in {reversal_s} s with \
                 the rudder amidships"
            ));
            let lengths = stop.track_reach_m.map_or(0.0, |metres| metres / lpp_m);
            let limit = stop.track_reach_criterion(lpp_m).limit;
            if lengths > limit && lengths <= TRACK_REACH_ALLOWED {
                remarks.push(format!(
                    "stopping: an Administration may allow up to {TRACK_REACH_ALLOWED} L to a \
                     ship of large displacement"
                ));
            }
        }
        remarks.extend(self.no_stopping.iter().map(|reason| format!("stopping: {reason}")));
        remarks
    }
}

/// Simulates the selected manoeuvres; one that leaves the physical range is reported, and the
/// others continue.
pub fn simulate_further_manoeuvres(
    model: &Model,
    law: &Law,
    ship: &Ship,
    settings: &ManoeuvreSettings,
    asked: &FurtherSelection,
) -> FurtherManoeuvres {
    let mut all = FurtherManoeuvres::default();
    if let Some(order) = asked.stop {
        match simulate_stop(model, law, ship, settings, order) {
            Ok(sailed) => {
                all.stopping = Some(sailed.metrics);
                all.tracks.push(("stopping".into(), sailed.track));
            }
            Err(reason @ StoppingError::NotReversing(_)) => {
                all.no_stopping = Some(reason.to_string())
            }
            Err(StoppingError::Stopped(stopped)) => {
                all.failures.push(format!("stopping: {stopped}"))
            }
        }
    }
    for rudder_deg in &asked.pull_outs_deg {
        let name = format!("pull-out {rudder_deg} deg");
        match simulate_pull_out(ship, *rudder_deg, settings) {
            Ok(sailed) => {
                all.pull_outs.push(sailed.metrics);
                all.tracks.push((name, sailed.track));
            }
            Err(stopped) => all.failures.push(format!("{name}: {stopped}")),
        }
    }
    // Spirals decide on stability where they are simulated, since they show the loop itself.
    all.straight_line_stable = is_straight_line_stable(&all.pull_outs);
    // An unknown stability is treated as instability, which the spirals then decide.
    let unstable = all.straight_line_stable != Some(true);
    if asked.spiral == SpiralSelection::Always
        || asked.spiral == SpiralSelection::WhereUnstable && unstable
    {
        match simulate_spirals(ship, settings) {
            Ok(sailed) => {
                all.straight_line_stable = Some(sailed.is_stable());
                all.spiral = Some(sailed);
            }
            Err(stopped) => all.failures.push(format!("spiral: {stopped}")),
        }
    }
    all
}
