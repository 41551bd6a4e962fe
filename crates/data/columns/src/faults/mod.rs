//! Faults of a recording: values that neither the samples before nor those after explain, frozen
//! sensors, repeated rows, and times that do not increase.

mod filter;
mod filtered_channel;
mod frozen;
mod integral;
mod repeats;
mod runs;
mod times;

pub use filtered_channel::FilteredChannel;
pub use repeats::repeated_rows;
pub use times::backward_times;

use std::f64::consts::PI;

use filter::RobustFilter;
use frozen::frozen_samples;
use integral::IntegralCheck;
use runs::{MAX_FAULTY_FRACTION, flagged_runs};

/// Maximum number of samples of a spike; longer faults are jumps.
const SPIKE: usize = 3;

/// Kind of fault of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SampleFault {
    /// A direction averaged across the full turn.
    WrappedAverage,
    /// A few samples that deviate from their neighbours.
    Spike,
    /// A longer run of samples that deviates from its neighbours.
    Jump,
    /// The last value, repeated.
    Frozen,
    /// A value that no instrument shows, such as -9999.
    Impossible,
}

impl SampleFault {
    /// Reason as written in a manifest.
    pub fn manifest_text(self) -> &'static str {
        match self {
            Self::WrappedAverage => "averages across the jump from 360 to 0 degrees",
            Self::Spike => "spikes",
            Self::Jump => "jumps that the values around do not explain",
            Self::Frozen => "frozen at one value",
            Self::Impossible => "placeholders for missing readings",
        }
    }
}

/// Returns the faults of a channel by sample, in order of the samples; none if more than a fifth
/// would be faulty. A time that is no number leaves its sample out.
pub fn sample_faults(t_s: &[f64], channel: &FilteredChannel) -> Vec<(usize, SampleFault)> {
    let mut values = channel.values.to_vec();
    let mut found: Vec<(usize, SampleFault)> = Vec::new();
    for (k, value) in values.iter_mut().enumerate().filter(|(_, v)| v.abs() > channel.impossible) {
        *value = f64::NAN;
        found.push((k, SampleFault::Impossible));
    }
    let channel = FilteredChannel { values: &values, ..*channel };
    let filter = RobustFilter::best_prediction(t_s, &channel);
    let frozen = frozen_samples(&values, &filter);
    let check = channel.integral.and_then(|integral| IntegralCheck::new(t_s, &channel, integral));
    let is_fault = |&(first, end): &(usize, usize)| {
        check.as_ref().is_none_or(|check| !check.confirms_run(first, end))
    };
    let runs = flagged_runs(&filter.rejected_samples(t_s));
    found.extend(runs.into_iter().filter(is_fault).flat_map(|(first, end)| {
        let fault = classify_run(&values, channel.is_direction, first, end);
        (first..end).map(move |k| (k, fault))
    }));
    found.extend(frozen.into_iter().map(|k| (k, SampleFault::Frozen)));
    found.sort_unstable();
    found.dedup_by_key(|(k, _)| *k);
    // With so many faults the model of the filter does not describe the channel, so none is
    // reported.
    let many = found.len() as f64 > MAX_FAULTY_FRACTION * values.len() as f64;
    if many { Vec::new() } else { found }
}

fn classify_run(values: &[f64], is_direction: bool, first: usize, end: usize) -> SampleFault {
    // An average across the wrap lies between neighbours that are more than half a turn apart.
    let before = first.checked_sub(1).and_then(|k| values.get(k));
    let crosses = before.zip(values.get(end)).is_some_and(|(a, b)| (a - b).abs() > PI);
    match (is_direction && crosses, end - first <= SPIKE) {
        (true, _) => SampleFault::WrappedAverage,
        (false, true) => SampleFault::Spike,
        (false, false) => SampleFault::Jump,
    }
}

#[cfg(test)]
mod tests;
