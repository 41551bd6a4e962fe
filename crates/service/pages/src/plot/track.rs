//! Data of a plot: channels over time with a style.

use std::collections::BTreeMap;

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Trajectory;
use sistership_simulation::state::{RECORDED_CHANNELS, at};

use crate::language::say;

/// Style of a line, of the outlines and of the dots on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LineStyle {
    /// Name in the legend.
    pub name: &'static str,
    pub line: &'static str,
    pub hull: &'static str,
    pub dot: &'static str,
}

/// Style of measured tracks.
pub(crate) const MEASURED: LineStyle = LineStyle {
    name: "measured",
    line: "line measured",
    hull: "hull measured",
    dot: "dot measured",
};

/// Styles of simulated tracks, in sequence.
pub(crate) const LINES: [LineStyle; 5] = [
    LineStyle { name: "a", line: "line a", hull: "hull a", dot: "dot a" },
    LineStyle { name: "b", line: "line b", hull: "hull b", dot: "dot b" },
    LineStyle { name: "c", line: "line c", hull: "hull c", dot: "dot c" },
    LineStyle { name: "d", line: "line d", hull: "hull d", dot: "dot d" },
    LineStyle { name: "e", line: "line e", hull: "hull e", dot: "dot e" },
];

/// Channels over time, SI and radians.
#[derive(Debug, Clone)]
pub(crate) struct PlotTrack {
    pub style: LineStyle,
    pub name: String,
    pub t_s: Vec<f64>,
    pub channels: BTreeMap<Channel, Vec<f64>>,
    /// Indices of the samples before which the record has a gap.
    pub gaps: Vec<usize>,
}

impl PlotTrack {
    /// Returns the track of a measured trial.
    pub fn from_trial(trial: &Trial) -> Self {
        Self {
            style: MEASURED,
            name: say("trial-measured").into(),
            t_s: trial.t_s.clone(),
            channels: trial.channels.clone(),
            gaps: trial.segments().into_iter().skip(1).map(|segment| segment.start).collect(),
        }
    }

    /// Returns the track of a simulation; without roll the roll angle is omitted.
    pub fn from_simulation(
        style: LineStyle,
        name: impl Into<String>,
        track: &Trajectory,
        rolls: bool,
    ) -> Self {
        // The rudder angle is a state of the simulation; revolutions are inputs.
        let state = RECORDED_CHANNELS.into_iter().chain([(Channel::Delta, at::DELTA)]);
        let state = state.filter(|(channel, _)| rolls || *channel != Channel::Phi);
        let mut channels: BTreeMap<Channel, Vec<f64>> =
            state.map(|(channel, place)| (channel, track.state_column(place))).collect();
        channels.insert(Channel::N, track.n_rps.clone());
        Self { style, name: name.into(), t_s: track.t_s.clone(), channels, gaps: Vec::new() }
    }

    /// Positions `(north, east)`, m; `None` if a channel of them is missing.
    pub fn positions(&self) -> Option<Vec<(f64, f64)>> {
        let (north, east) = (self.channels.get(&Channel::X)?, self.channels.get(&Channel::Y)?);
        Some(north.iter().copied().zip(east.iter().copied()).collect())
    }

    /// Returns true if a gap lies between two samples.
    pub fn has_gap(&self, from: usize, to: usize) -> bool {
        self.gaps.iter().any(|gap| from < *gap && *gap <= to)
    }
}
