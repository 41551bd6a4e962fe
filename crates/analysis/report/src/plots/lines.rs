//! Lines of a trial: measured, source, refined.

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::recorded::TrialReplay;
use sistership_simulation::state::at;

use crate::replayed::ReplayedTrial;

/// Samples of one line: index in the trial, and value.
pub(crate) struct PlottedLine<T> {
    pub class: &'static str,
    pub samples: Vec<usize>,
    pub values: Vec<T>,
}

/// Index of a channel in the state vector.
fn state_index(channel: Channel) -> Option<usize> {
    sistership_simulation::state::RECORDED_CHANNELS
        .into_iter()
        .find(|(known, _)| *known == channel)
        .map(|(_, place)| place)
}

/// Returns the lines of a channel: measured, source and refined model.
pub(crate) fn channel_lines(
    replayed: &ReplayedTrial<'_>,
    channel: Channel,
    factor: f64,
) -> Vec<PlottedLine<f64>> {
    let mut lines = Vec::new();
    if let Some(values) = replayed.trial.channel(channel) {
        let values: Vec<f64> = values.iter().map(|value| value * factor).collect();
        lines.push(PlottedLine { class: "measured", samples: (0..values.len()).collect(), values });
    }
    // Inputs such as the rudder are not part of the state and have one line only.
    let Some(place) = state_index(channel) else { return lines };
    // A simulation may stop early, so it has its own list of samples.
    for (class, run) in [("source", &replayed.source), ("refined", &replayed.refined)] {
        let values = run.track.states.iter().map(|state| state[place] * factor).collect();
        lines.push(PlottedLine { class, samples: run.samples.clone(), values });
    }
    lines
}

/// Returns the lines of positions `(north, east)`, in the same order.
pub(crate) fn position_lines(replayed: &ReplayedTrial<'_>) -> Vec<PlottedLine<(f64, f64)>> {
    let trial = replayed.trial;
    let mut lines = Vec::new();
    if let (Some(north), Some(east)) = (trial.channel(Channel::X), trial.channel(Channel::Y)) {
        let values: Vec<(f64, f64)> = north.iter().copied().zip(east.iter().copied()).collect();
        lines.push(PlottedLine { class: "measured", samples: (0..values.len()).collect(), values });
    }
    lines.extend(
        [("source", &replayed.source), ("refined", &replayed.refined)]
            .map(|(class, run)| track_line(class, run)),
    );
    lines
}

fn track_line(class: &'static str, run: &TrialReplay) -> PlottedLine<(f64, f64)> {
    let values = run.track.states.iter().map(|state| (state[at::X], state[at::Y])).collect();
    PlottedLine { class, samples: run.samples.clone(), values }
}

/// True if the record has a gap between two samples.
pub(crate) fn has_gap(trial: &Trial, starts: &[usize], from: usize, to: usize) -> bool {
    starts.iter().any(|start| from < *start && *start <= to && *start < trial.len())
}

/// Returns the samples at which gap-free segments start.
pub(crate) fn segment_starts(trial: &Trial) -> Vec<usize> {
    trial.segments().into_iter().map(|segment| segment.start).collect()
}
