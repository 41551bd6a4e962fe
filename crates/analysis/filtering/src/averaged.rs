//! Means of a trial over intervals in which a ship hardly moves.
//!
//! White noise of the readings is independent from mean to mean and smaller by the root of their
//! number, so that means have all the information on any motion that is slow beside the interval
//! (the sufficient statistic of a constant). A filter along them takes as much less time.

use std::ops::Range;

use sistership_model::Trial;
use sistership_model::trial::Channel;

use super::jumps::undisturbed_ranges;
use super::thresholds::RESIDUAL;

/// Directions, whose means are those of unit vectors.
const DIRECTIONS: [Channel; 2] = [Channel::WindFrom, Channel::ApparentWindFrom];

/// Returns the means of a trial over intervals of at most `step_s`, without samples within
/// `settles_s` of a jump; none where an interval has fewer than two samples.
pub fn average_trial(trial: &Trial, step_s: f64, settles_s: f64) -> Option<Trial> {
    let wanted = (step_s / trial.interval_s().max(1e-9) + 1e-9).floor() as usize;
    let count = wanted.min(trial.len() / RESIDUAL.least_means);
    if count < 2 {
        return None;
    }
    let ranges = undisturbed_ranges(trial, settles_s);
    let of = |range: Range<usize>| {
        (0..range.len() / count)
            .map(move |k| range.start + k * count..range.start + (k + 1) * count)
    };
    let blocks: Vec<Range<usize>> = ranges.into_iter().flat_map(of).collect();
    let mean = |values: &[f64], block: &Range<usize>| {
        values[block.clone()].iter().sum::<f64>() / count as f64
    };
    let means = |values: &[f64]| blocks.iter().map(|block| mean(values, block)).collect();
    let directions = |values: &[f64]| {
        let sum = |block: &Range<usize>, of: fn(f64) -> f64| {
            values[block.clone()].iter().map(|value| of(*value)).sum::<f64>()
        };
        blocks.iter().map(|block| sum(block, f64::sin).atan2(sum(block, f64::cos))).collect()
    };
    let channel = |(channel, values): (&Channel, &Vec<f64>)| {
        let is_direction = DIRECTIONS.contains(channel);
        (*channel, if is_direction { directions(values) } else { means(values) })
    };
    Some(Trial {
        name: trial.name.clone(),
        t_s: means(&trial.t_s),
        channels: trial.channels.iter().map(channel).collect(),
        manoeuvre: trial.manoeuvre.clone(),
        depth_m: trial.depth_m,
        velocity: trial.velocity,
        warnings: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn trial() -> Trial {
        let wind = |k: usize| if k.is_multiple_of(2) { 0.1 } else { std::f64::consts::TAU - 0.1 };
        Trial {
            t_s: (0..1000).map(|k| 0.5 * k as f64).collect(),
            channels: [
                (Channel::U, (0..1000).map(|k| k as f64).collect()),
                (Channel::WindFrom, (0..1000).map(wind).collect()),
            ]
            .into(),
            ..Trial::default()
        }
    }

    #[test]
    fn means_stand_in_the_middle_of_their_interval() {
        let means = average_trial(&trial(), 2.2, 3.0).unwrap();
        assert_eq!((means.len(), means.t_s[1]), (250, 2.75));
        assert_eq!(means.channel(Channel::U).unwrap()[1], 5.5);
        // North, from both sides.
        assert!(means.channel(Channel::WindFrom).unwrap().iter().all(|from| from.abs() < 1e-12));
    }

    #[test]
    fn short_trials_keep_their_samples() {
        assert!(average_trial(&trial(), 0.7, 3.0).is_none());
        let short = Trial {
            t_s: trial().t_s[..90].to_vec(),
            channels: trial().channels.into_iter().map(|(c, v)| (c, v[..90].to_vec())).collect(),
            ..Trial::default()
        };
        assert!(average_trial(&short, 20.0, 3.0).is_none());
    }
}
