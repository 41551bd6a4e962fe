//! A few trials that stand for many: what costs by the sample is learned on them.
//!
//! A maximin design (Johnson, Moore and Ylvisaker 1990, "Minimax and maximin distance designs",
//! J. Stat. Plan. Inference 26): each next trial is the one farthest from those taken, so that what
//! is seldom sailed is among them as well as what is common.

use std::collections::BTreeMap;

use sistership_model::trial::{Channel, Trial};

/// Of fewer trials nothing is left away: they would not show how trials differ, and of six each may
/// be left out of the fit once.
const LEAST: usize = 6;

/// Where a ship was and how it headed say nothing of how it was sailed.
const PLACE: [Channel; 3] = [Channel::X, Channel::Y, Channel::Psi];

/// Places, in order, of trials that together have about `samples` samples; all of them where they
/// have no more than that, and at least [`LEAST`].
pub(super) fn representative(trials: &[&Trial], samples: usize) -> Vec<usize> {
    let all = 0..trials.len();
    if trials.iter().map(|trial| trial.len()).sum::<usize>() <= samples {
        return all.collect();
    }
    let points = scaled(trials.iter().map(|trial| signature(trial)).collect());
    let mut taken: Vec<usize> = Vec::new();
    let mut left: Vec<usize> = all.collect();
    let mut sum = 0;
    while let Some(next) = farthest(&points, &taken, &left) {
        let place = left.swap_remove(next);
        sum += trials[place].len();
        if taken.len() >= LEAST && sum > samples {
            break;
        }
        taken.push(place);
    }
    taken.sort_unstable();
    taken
}

/// Mean and standard deviation of each channel that says how the ship moved and was steered.
fn signature(trial: &Trial) -> BTreeMap<Channel, [f64; 2]> {
    let recorded = trial.channels.iter().filter(|(channel, _)| !PLACE.contains(channel));
    let moments = |values: &Vec<f64>| {
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        [mean, (squares / count).sqrt()]
    };
    recorded.map(|(&channel, values)| (channel, moments(values))).collect()
}

/// One coordinate for each number, scaled to a deviation of one over the trials; what a trial did
/// not record is the mean of the others.
fn scaled(signatures: Vec<BTreeMap<Channel, [f64; 2]>>) -> Vec<Vec<f64>> {
    let mut points = vec![Vec::new(); signatures.len()];
    for channel in Channel::all() {
        for part in 0..2 {
            let of = |of: &BTreeMap<Channel, [f64; 2]>| of.get(&channel).map(|both| both[part]);
            let known: Vec<f64> = signatures.iter().filter_map(of).collect();
            let count = known.len().max(1) as f64;
            let mean = known.iter().sum::<f64>() / count;
            let squares: f64 = known.iter().map(|value| (value - mean).powi(2)).sum();
            let deviation = (squares / count).sqrt();
            if deviation > 0.0 {
                points.iter_mut().zip(&signatures).for_each(|(point, own)| {
                    point.push((of(own).unwrap_or(mean) - mean) / deviation)
                });
            }
        }
    }
    points
}

/// The place in `left` of what is farthest from those taken; at first, of what is nearest to the
/// mean, which is the origin.
fn farthest(points: &[Vec<f64>], taken: &[usize], left: &[usize]) -> Option<usize> {
    let square = |point: &[f64]| point.iter().map(|x| x * x).sum::<f64>();
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
    let worth = |&place: &usize| {
        let point = &points[place];
        let nearest = taken.iter().map(|&other| apart(point, &points[other]));
        nearest.min_by(f64::total_cmp).unwrap_or(-square(point))
    };
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
        assert_eq!(representative(&trials, 20), [0, 1]);
    }

    #[test]
    fn the_common_and_the_extremes_stand_for_many() {
        let common = (0..10).map(|k| 0.1 + 1e-3 * k as f64);
        let rates = common.chain([-0.5, 0.5]);
        let trials: Vec<Trial> = rates.map(|rate| sailed(rate, 10)).collect();
        let trials: Vec<&Trial> = trials.iter().collect();
        let taken = representative(&trials, 70);
        assert_eq!(taken.len(), 7);
        assert!(taken.contains(&10) && taken.contains(&11), "{taken:?}");
        assert_eq!(representative(&trials, 10).len(), LEAST);
    }

    #[test]
    fn one_trial_is_taken_however_long() {
        let trial = sailed(0.1, 100);
        assert_eq!(representative(&[&trial], 10), [0]);
    }
}
