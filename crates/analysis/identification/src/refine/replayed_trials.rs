//! Trials for comparison with simulations: with fewer samples where instruments record more often
//! than a simulation needs, and smoothed against the noise of single readings.

use std::ops::Range;

use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::recorded::ReplaySettings;

use super::smoothing::{ReadingsAbout, is_motion};
use super::steps::step_s;
use sistership_priors::transfer::trial_approach;

/// Trials with no more samples than simulations need.
pub struct ReplayedTrials {
    /// The trials, in their order.
    pub trials: Vec<Trial>,
    /// Longest step of a simulation, s.
    pub step_s: f64,
}

impl ReplayedTrials {
    /// Creates thinned trials with motions smoothed in a window of `smoothing_s`; as recorded if
    /// there is none. Without a known length or approach speed no sample is dropped.
    pub fn new(
        law: &Law,
        lpp_m: Option<f64>,
        training: &[&Trial],
        smoothing_s: Option<f64>,
    ) -> Self {
        let step_s = lpp_m
            .zip(trial_approach(training))
            .map(|(l, approach)| step_s(law, l / approach.speed_m_s));
        let usual_s = ReplaySettings::default().step_s;
        Self {
            trials: training.iter().map(|trial| thin_trial(trial, step_s, smoothing_s)).collect(),
            // Ships that roll keep the usual step.
            step_s: step_s.filter(|_| !law.has_roll()).unwrap_or(usual_s),
        }
    }
}

/// Thins a trial to samples as far apart as a simulation may step; no sample is joined to another
/// across a gap. Keeps every sample if thinning would drop a part between gaps.
fn thin_trial(trial: &Trial, step_s: Option<f64>, smoothing_s: Option<f64>) -> Trial {
    // Without thinning and smoothing the trial is used as it is.
    let every = sample_stride(trial, step_s);
    if every == 1 && smoothing_s.is_none() {
        return trial.clone();
    }
    let parts = trial.segments();
    let kept = KeptSamples::new(trial, &parts, every, smoothing_s);
    let column = |channel: Channel, column: &[f64]| match channel {
        _ if is_motion(channel) => kept.smoothed_samples(channel, column),
        _ if is_averaged_input(channel) => kept.mean_samples(column),
        _ => kept.select_samples(column),
    };
    let channels =
        trial.channels.iter().map(|(&channel, values)| (channel, column(channel, values)));
    Trial {
        t_s: kept.select_samples(&trial.t_s),
        channels: channels.collect(),
        warnings: Vec::new(),
        ..trial.clone()
    }
}

/// Stride from one kept sample to the next.
fn sample_stride(trial: &Trial, step_s: Option<f64>) -> usize {
    let interval_s = trial.interval_s();
    let every = step_s
        .filter(|_| interval_s > 0.0)
        // The small term keeps a ratio that is whole but for rounding.
        .map_or(1, |step_s| (step_s / interval_s + 1e-9).floor().max(1.0) as usize);
    let parts = trial.segments();
    let kept = KeptSamples::new(trial, &parts, every, None);
    // Thinning must not merge parts, nor lose a short one: the number of parts has to stay.
    let fewer = Trial { t_s: kept.select_samples(&trial.t_s), ..Trial::default() };
    if fewer.segments().len() == parts.len() { every } else { 1 }
}

/// The samples of a trial that are kept.
struct KeptSamples<'a> {
    every: usize,
    /// Kept samples, each with its part between gaps.
    samples: Vec<(usize, &'a Range<usize>)>,
    /// Readings from which each kept sample is smoothed; none where they are too few.
    about: Vec<Option<ReadingsAbout>>,
}

impl<'a> KeptSamples<'a> {
    fn new(
        trial: &Trial,
        parts: &'a [Range<usize>],
        every: usize,
        smoothing_s: Option<f64>,
    ) -> Self {
        let stepped = |part: &'a Range<usize>| part.clone().step_by(every).map(move |k| (k, part));
        let samples: Vec<_> = parts.iter().flat_map(stepped).collect();
        let about = |&(k, part): &(usize, &Range<usize>)| {
            ReadingsAbout::new(&trial.t_s, part, trial.t_s[k], smoothing_s?)
        };
        Self { every, about: samples.iter().map(about).collect(), samples }
    }

    /// Values of a column at the kept samples.
    fn select_samples(&self, column: &[f64]) -> Vec<f64> {
        self.samples.iter().map(|&(k, _)| column[k]).collect()
    }

    /// Smoothed values of a motion channel at the kept samples; as recorded where readings are too
    /// few.
    fn smoothed_samples(&self, channel: Channel, column: &[f64]) -> Vec<f64> {
        let one = |(&(k, _), about): (&(usize, _), &Option<ReadingsAbout>)| {
            about.as_ref().map_or(column[k], |about| about.value(channel, column))
        };
        self.samples.iter().zip(&self.about).map(one).collect()
    }

    /// Means of an input about each kept sample.
    fn mean_samples(&self, column: &[f64]) -> Vec<f64> {
        let one = |&(k, part): &(usize, &Range<usize>)| {
            mean_around(&column[part.clone()], k - part.start, self.every)
        };
        self.samples.iter().map(one).collect()
    }
}

/// Returns true if a channel is an input whose values between samples matter: a rudder moves within
/// one step.
fn is_averaged_input(channel: Channel) -> bool {
    matches!(channel, Channel::Delta | Channel::N | Channel::WindSpeed)
}

/// The mean of `count` samples about a place, fewer at the ends.
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
        let fewer = thin_trial(&trial(30.0), Some(0.35), None);
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
        let fewer = thin_trial(&trial, Some(0.35), None);
        let impulse = 0.3 * fewer.channel(Channel::Delta).unwrap().iter().sum::<f64>();
        assert!((impulse - 0.1 * 40.0).abs() < 0.1, "{impulse}");
    }

    #[test]
    fn slow_records_and_gaps_that_would_vanish_are_left_as_they_are() {
        assert_eq!(thin_trial(&trial(30.0), Some(0.15), None), trial(30.0));
        assert_eq!(
            thin_trial(&trial(0.1), Some(0.35), None),
            trial(0.1),
            "a gap of a fifth of a second"
        );
        assert_eq!(thin_trial(&trial(30.0), None, None), trial(30.0));
    }

    #[test]
    fn motions_are_smoothed_and_what_drives_them_is_not() {
        let mut trial = trial(30.0);
        let scatter = |k: usize| if k.is_multiple_of(2) { 0.1 } else { -0.1 };
        let scattered: Vec<f64> = (0..100).map(|k| 1.0 + scatter(k)).collect();
        trial.channels = [(Channel::U, scattered.clone()), (Channel::Delta, scattered)].into();
        let smooth = thin_trial(&trial, None, Some(2.0));
        assert_eq!(smooth.t_s, trial.t_s);
        assert_eq!(smooth.channel(Channel::Delta), trial.channel(Channel::Delta));
        let far = |u: &f64| (u - 1.0).abs();
        assert!(smooth.channel(Channel::U).unwrap().iter().map(far).fold(0.0, f64::max) < 0.07);
        let fewer = thin_trial(&trial, Some(0.35), Some(2.0));
        let place = |t: f64| smooth.t_s.iter().position(|s| *s == t).unwrap();
        let same: Vec<f64> =
            fewer.t_s.iter().map(|t| smooth.channel(Channel::U).unwrap()[place(*t)]).collect();
        assert_eq!(fewer.channel(Channel::U).unwrap(), same, "of all readings, not of those kept");
    }
}
