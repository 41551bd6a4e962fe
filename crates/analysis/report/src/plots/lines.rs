//! The three lines of a trial: measured, source, refined.

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::recorded::Replay;
use sistership_simulation::state::at;

use crate::replayed::ReplayedTrial;

/// Samples of one line: place in the trial and value.
pub(crate) struct PlottedLine<T> {
    pub class: &'static str,
    pub samples: Vec<usize>,
    pub values: Vec<T>,
}

/// Where a channel stands in the state.
fn place(channel: Channel) -> Option<usize> {
    sistership_simulation::state::RECORDED
        .into_iter()
        .find(|(known, _)| *known == channel)
        .map(|(_, place)| place)
}

/// A channel over the samples, measured first, then the source, then the refined model.
pub(crate) fn channel(
    replayed: &ReplayedTrial<'_>,
    channel: Channel,
    factor: f64,
) -> Vec<PlottedLine<f64>> {
    let mut lines = Vec::new();
    if let Some(values) = replayed.trial.channel(channel) {
        let values: Vec<f64> = values.iter().map(|value| value * factor).collect();
        lines.push(PlottedLine { class: "measured", samples: (0..values.len()).collect(), values });
    }
    let Some(place) = place(channel) else { return lines };
    for (class, run) in [("source", &replayed.source), ("refined", &replayed.refined)] {
        let values = run.track.states.iter().map(|state| state[place] * factor).collect();
        lines.push(PlottedLine { class, samples: run.samples.clone(), values });
    }
    lines
}

/// Positions `(north, east)`, likewise.
pub(crate) fn positions(replayed: &ReplayedTrial<'_>) -> Vec<PlottedLine<(f64, f64)>> {
    let trial = replayed.trial;
    let mut lines = Vec::new();
    if let (Some(north), Some(east)) = (trial.channel(Channel::X), trial.channel(Channel::Y)) {
        let values: Vec<(f64, f64)> = north.iter().copied().zip(east.iter().copied()).collect();
        lines.push(PlottedLine { class: "measured", samples: (0..values.len()).collect(), values });
    }
    lines.extend(
        [("source", &replayed.source), ("refined", &replayed.refined)]
            .map(|(class, run)| track(class, run)),
    );
    lines
}

fn track(class: &'static str, run: &Replay) -> PlottedLine<(f64, f64)> {
    let values = run.track.states.iter().map(|state| (state[at::X], state[at::Y])).collect();
    PlottedLine { class, samples: run.samples.clone(), values }
}

/// Whether a gap of the record lies between two of its samples.
pub(crate) fn has_gap(trial: &Trial, starts: &[usize], from: usize, to: usize) -> bool {
    starts.iter().any(|start| from < *start && *start <= to && *start < trial.len())
}

/// The samples at which gap-free parts start.
pub(crate) fn starts(trial: &Trial) -> Vec<usize> {
    trial.segments().into_iter().map(|segment| segment.start).collect()
}
