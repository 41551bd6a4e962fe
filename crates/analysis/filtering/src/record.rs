//! Readings of a trial as a filter uses them.

use sistership_model::trial::{Channel, Trial};
use sistership_model::trial_input::{TrialInput, find_input};

use super::jumps::undisturbed_ranges;
use sistership_identification::refine::RefineError;

/// A trial as a filter reads it: times, readings, a smooth path through them, and inputs.
#[derive(Debug, Clone)]
pub struct TrialReadings<'a> {
    /// The trial.
    pub trial: &'a Trial,
    /// The samples that are used, in gap-free parts.
    pub parts: Vec<Vec<usize>>,
    /// Number of these samples per reading.
    pub every: usize,
}

impl<'a> TrialReadings<'a> {
    /// Uses one of several samples, such that no interval is shorter than `least_step_s`, and none
    /// within `settles_s` of a jump.
    pub fn new(trial: &'a Trial, least_step_s: f64, settles_s: f64) -> Self {
        // The small shares keep exact multiples of the interval from being rounded down.
        let stride = (least_step_s / trial.interval_s().max(1e-9) + 1e-9).floor().max(1.0) as usize;
        let parts = undisturbed_ranges(trial, settles_s)
            .into_iter()
            .map(|range| range.step_by(stride).collect::<Vec<usize>>());
        Self { trial, parts: parts.filter(|part| part.len() > 2).collect(), every: 1 }
    }

    /// Interval between the samples that are used, s; none where there are fewer than two.
    pub fn step_s(&self) -> Option<f64> {
        let part = self.parts.first()?;
        Some(self.trial.t_s[*part.get(1)?] - self.trial.t_s[part[0]])
    }

    /// Sets the interval between readings, s.
    pub fn read_every(&mut self, interval_s: f64) {
        let samples = self.step_s().map_or(1.0, |step_s| (interval_s / step_s).round());
        self.every = samples.max(1.0) as usize;
    }

    /// Number of samples that are used.
    pub fn len(&self) -> usize {
        self.parts.iter().map(Vec::len).sum()
    }

    /// Returns true if no sample is used.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns true if a channel was recorded.
    pub fn has_channel(&self, channel: Channel) -> bool {
        self.trial.channel(channel).is_some()
    }

    /// Returns the samples of a required channel.
    ///
    /// # Errors
    /// Returns an error that names the trial and the channel if it was not recorded.
    pub fn required_channel(&self, channel: Channel) -> Result<&'a [f64], RefineError> {
        self.trial
            .channel(channel)
            .ok_or_else(|| RefineError::Channel { trial: self.trial.name.clone(), channel })
    }

    /// Returns an input of a law over the samples of the trial: recorded, or constant.
    ///
    /// # Errors
    /// Returns an error that names the trial and the channel if there is neither a record nor a
    /// default.
    pub fn input(&self, name: &str, default: Option<f64>) -> Result<Vec<f64>, RefineError> {
        Ok(match find_input(self.trial, name, default)? {
            TrialInput::Samples(samples) => samples.into_owned(),
            TrialInput::Constant(value) => vec![value; self.trial.len()],
        })
    }
}

/// Smooths values by a parabola through each five samples, read in their middle: white noise loses
/// half its variance, a motion of more than some ten samples nothing. The model is linearised along
/// it.
pub fn smooth_parabolic(values: &[f64]) -> Vec<f64> {
    let fitted = |w: &[f64]| (17.0 * w[2] + 12.0 * (w[1] + w[3]) - 3.0 * (w[0] + w[4])) / 35.0;
    let mut out = values.to_vec();
    for (k, window) in values.windows(5).enumerate() {
        out[k + 2] = fitted(window);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola is its own, an impulse has the weights of Savitzky and Golay (1964), the two
    /// samples at each end are kept.
    #[test]
    fn five_samples_are_smoothed_by_a_parabola() {
        let parabola: Vec<f64> = (0..9).map(|k| 2.0 - f64::from(k) + f64::from(k * k)).collect();
        for (own, exact) in smooth_parabolic(&parabola).iter().zip(&parabola) {
            assert!((own - exact).abs() < 1e-12, "{own} {exact}");
        }
        let impulse = smooth_parabolic(&[0.0, 0.0, 0.0, 0.0, 35.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(impulse, [0.0, 0.0, -3.0, 12.0, 17.0, 12.0, -3.0, 0.0, 0.0]);
        let ends = smooth_parabolic(&[35.0, 0.0, 0.0, 0.0, 0.0, 7.0]);
        assert_eq!((ends[0], ends[1], ends[4], ends[5]), (35.0, 0.0, 0.0, 7.0));
    }
}
