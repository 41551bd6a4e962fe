//! Trials as simulations of them are compared: with fewer samples, where instruments record more
//! often than a simulation needs.

use sistership_dynamics::recorded::ReplaySettings;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};

use super::steps::step_s;
use sistership_sources::transfer::approach_of;

/// Trials with no more samples than simulations need.
pub struct ReplayedTrials {
    /// The trials, in their order.
    pub trials: Vec<Trial>,
    /// Longest step of a simulation, s.
    pub step_s: f64,
}

impl ReplayedTrials {
    /// Of trials; with as few samples as a search needs where it is `economical`, means of what
    /// drives the ship between them.
    pub fn new(law: &Law, lpp_m: Option<f64>, training: &[&Trial], economical: bool) -> Self {
        let step_s = lpp_m
            .zip(approach_of(training))
            .map(|(l, approach)| step_s(law, l / approach.speed_m_s, economical));
        let usual_s = ReplaySettings::default().step_s;
        Self {
            trials: training.iter().map(|trial| thinned(trial, step_s, economical)).collect(),
            step_s: step_s.filter(|_| economical && !law.has_roll()).unwrap_or(usual_s),
        }
    }
}

/// Every so many samples of a trial, so that they are as far apart as a simulation may step and no
/// further; none between gaps is joined to another. The trial itself where that would leave gaps
/// out, or nothing.
fn thinned(trial: &Trial, step_s: Option<f64>, in_means: bool) -> Trial {
    let interval_s = trial.interval_s();
    let every = step_s
        .filter(|_| interval_s > 0.0)
        .map_or(1, |step_s| (step_s / interval_s + 1e-9).floor().max(1.0) as usize);
    let parts = trial.segments();
    let kept: Vec<usize> = parts.iter().flat_map(|part| part.clone().step_by(every)).collect();
    let of = |column: &[f64]| kept.iter().map(|&k| column[k]).collect::<Vec<f64>>();
    let around = |column: &[f64]| {
        let each =
            parts.iter().flat_map(|part| part.clone().step_by(every).map(move |k| (k, part)));
        each.map(|(k, part)| mean_around(&column[part.clone()], k - part.start, every)).collect()
    };
    let channels = trial.channels.iter().map(|(&channel, column)| {
        (channel, if in_means && drives(channel) { around(column) } else { of(column) })
    });
    let fewer = Trial {
        t_s: of(&trial.t_s),
        channels: channels.collect(),
        warnings: Vec::new(),
        ..trial.clone()
    };
    if every > 1 && fewer.segments().len() == parts.len() { fewer } else { trial.clone() }
}

/// What is put in between samples counts as much as at them: a rudder moves within one.
fn drives(channel: Channel) -> bool {
    matches!(channel, Channel::Delta | Channel::N | Channel::WindSpeed)
}

/// The mean of so many samples about one.
fn mean_around(column: &[f64], place: usize, count: usize) -> f64 {
    let before = place.saturating_sub(count / 2);
    let near = &column[before..(place + count - count / 2).min(column.len())];
    near.iter().sum::<f64>() / near.len() as f64
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn trial(gap_s: f64) -> Trial {
        let t_s: Vec<f64> =
            (0..100).map(|k| 0.1 * f64::from(k) + if k < 51 { 0.0 } else { gap_s }).collect();
        Trial { channels: [(Channel::U, t_s.clone())].into(), t_s, ..Trial::default() }
    }

    #[test]
    fn samples_are_as_far_apart_as_a_step_may_be() {
        let fewer = thinned(&trial(30.0), Some(0.35), true);
        assert_eq!((fewer.len(), fewer.segments().len()), (17 + 17, 2));
        assert!((fewer.interval_s() - 0.3).abs() < 1e-9);
        assert_eq!(fewer.channel(Channel::U).unwrap(), fewer.t_s);
        assert_eq!(fewer.t_s[17], trial(30.0).t_s[51], "each part from its start");
    }

    #[test]
    fn a_rudder_moves_between_samples() {
        let mut trial = trial(30.0);
        let step = (0..100).map(|k| if (20..60).contains(&k) { 1.0 } else { 0.0 }).collect();
        trial.channels.insert(Channel::Delta, step);
        let fewer = thinned(&trial, Some(0.35), true);
        let impulse = 0.3 * fewer.channel(Channel::Delta).unwrap().iter().sum::<f64>();
        assert!((impulse - 0.1 * 40.0).abs() < 0.1, "{impulse}");
    }

    #[test]
    fn slow_records_and_gaps_that_would_vanish_are_left_as_they_are() {
        assert_eq!(thinned(&trial(30.0), Some(0.15), true), trial(30.0));
        assert_eq!(
            thinned(&trial(0.1), Some(0.35), true),
            trial(0.1),
            "a gap of a fifth of a second"
        );
        assert_eq!(thinned(&trial(30.0), None, true), trial(30.0));
    }
}
