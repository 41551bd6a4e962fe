//! Representative subset of many trials, on which computations with a cost per sample are made.
//!
//! A maximin design (Johnson, Moore and Ylvisaker 1990, "Minimax and maximin distance designs", J.
//! Stat. Plan. Inference 26): each next trial is the one farthest from those selected, so that rare
//! manoeuvres are included as well as common ones.

use std::collections::BTreeMap;

use sistership_model::trial::{Channel, Trial};

/// Fewest trials that are selected: fewer would not show how trials differ, and each of six may be
/// held out of the fit once.
const LEAST: usize = 6;

/// Channels of position and heading, which carry no information on the manoeuvre.
const PLACE: [Channel; 3] = [Channel::X, Channel::Y, Channel::Psi];

/// Indices, in order, of trials that together have about `samples` samples; all of them where they
/// have no more than that, and at least [`LEAST`].
pub(super) fn representative_trials(trials: &[&Trial], samples: usize) -> Vec<usize> {
    let all = 0..trials.len();
    if trials.iter().map(|trial| trial.len()).sum::<usize>() <= samples {
        return all.collect();
    }
    // Distances are between the standardised moments of the trials.
    let points = standardise_moments(trials.iter().map(|trial| channel_moments(trial)).collect());
    let mut taken: Vec<usize> = Vec::new();
    let mut left: Vec<usize> = all.collect();
    let mut sum = 0;
    while let Some(next) = farthest_trial(&points, &taken, &left) {
        let place = left.swap_remove(next);
        sum += trials[place].len();
        // The limit is passed only as far as the fewest trials need.
        if taken.len() >= LEAST && sum > samples {
            break;
        }
        taken.push(place);
    }
    taken.sort_unstable();
    taken
}

/// Mean and standard deviation of each channel of the ship's motion and steering.
fn channel_moments(trial: &Trial) -> BTreeMap<Channel, [f64; 2]> {
    let recorded = trial.channels.iter().filter(|(channel, _)| !PLACE.contains(channel));
    let moments = |values: &Vec<f64>| {
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        [mean, (squares / count).sqrt()]
    };
    recorded.map(|(&channel, values)| (channel, moments(values))).collect()
}

/// Coordinates of each trial, one per moment, scaled to a standard deviation of one over the
/// trials; a channel that a trial did not record has the mean of the others.
fn standardise_moments(signatures: Vec<BTreeMap<Channel, [f64; 2]>>) -> Vec<Vec<f64>> {
    let mut points = vec![Vec::new(); signatures.len()];
    for channel in Channel::all_channels() {
        // Mean and standard deviation of a channel are separate coordinates.
        for part in 0..2 {
            let of = |of: &BTreeMap<Channel, [f64; 2]>| of.get(&channel).map(|both| both[part]);
            let known: Vec<f64> = signatures.iter().filter_map(of).collect();
            let count = known.len().max(1) as f64;
            let mean = known.iter().sum::<f64>() / count;
            let squares: f64 = known.iter().map(|value| (value - mean).powi(2)).sum();
            let deviation = (squares / count).sqrt();
            // A moment that is equal on all trials does not separate them.
            if deviation > 0.0 {
                points.iter_mut().zip(&signatures).for_each(|(point, own)| {
                    point.push((of(own).unwrap_or(mean) - mean) / deviation)
                });
            }
        }
    }
    points
}

/// Index in `left` of the trial farthest from those selected; of the first, the one nearest to the
/// mean, which is the origin.
fn farthest_trial(points: &[Vec<f64>], taken: &[usize], left: &[usize]) -> Option<usize> {
    let square = |point: &[f64]| point.iter().map(|x| x * x).sum::<f64>();
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
    let worth = |&place: &usize| {
        let point = &points[place];
        let nearest = taken.iter().map(|&other| apart(point, &points[other]));
        nearest.min_by(f64::total_cmp).unwrap_or(-square(point))
    };
    // Ties are resolved by the lower index, so that the selection is reproducible.
    let order = |a: &usize, b: &usize| worth(a).total_cmp(&worth(b)).then(b.cmp(a));
    (0..left.len()).max_by(|&a, &b| order(&left[a], &left[b]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sailed(yaw_rate: f64, samples: usize) -> Trial {
        let r = (0..samples).map(|k| yaw_rate * (1.0 + 0.1 * (k % 2) as f64)).collect();
        let t_s = (0..samples).map(|k| k as f64).collect();
        Trial { t_s, channels: [(Channel::R, r)].into(), ..Trial::default() }
    }

    #[test]
    fn few_samples_are_all_taken() {
        let trials = [sailed(0.1, 10), sailed(0.2, 10)];
        let trials: Vec<&Trial> = trials.iter().collect();
        assert_eq!(representative_trials(&trials, 20), [0, 1]);
    }

    #[test]
    fn the_common_and_the_extremes_stand_for_many() {
        let common = (0..10).map(|k| 0.1 + 1e-3 * k as f64);
        let rates = common.chain([-0.5, 0.5]);
        let trials: Vec<Trial> = rates.map(|rate| sailed(rate, 10)).collect();
        let trials: Vec<&Trial> = trials.iter().collect();
        let taken = representative_trials(&trials, 70);
        assert_eq!(taken.len(), 7);
        assert!(taken.contains(&10) && taken.contains(&11), "{taken:?}");
        assert_eq!(representative_trials(&trials, 10).len(), LEAST);
    }

    #[test]
    fn one_trial_is_taken_however_long() {
        let trial = sailed(0.1, 100);
        assert_eq!(representative_trials(&[&trial], 10), [0]);
    }
}
