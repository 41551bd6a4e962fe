//! Smoothing of recorded motions by local quadratic regression, against the noise of single
//! readings.
//!
//! A parabola is fitted by least squares to the readings about a time and read at that time
//! (Cleveland 1979, J Am Stat Assoc 74, 829-836, section 2, with weights of one). Near an end of a
//! part the window stands still, as that of Savitzky and Golay's filter does.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};
use sistership_model::trial::Channel;
use sistership_simulation::error::wrap_angle;
use sistership_simulation::state::RECORDED_CHANNELS;

/// Fewest readings that determine a parabola despite their noise.
const MIN_READINGS: usize = 5;

/// Returns true if a channel belongs to the ship's motion. Inputs are not smoothed: they change
/// abruptly.
pub(super) fn is_motion(channel: Channel) -> bool {
    RECORDED_CHANNELS.iter().any(|(recorded, _)| *recorded == channel)
}

/// The readings in a window about a time, with their weights.
pub(super) struct ReadingsAbout {
    range: Range<usize>,
    weights: Vec<f64>,
}

impl ReadingsAbout {
    /// Selects the readings of a part of a record in a window of `window_s` about `t`; `None` if
    /// they are too few.
    pub fn new(t_s: &[f64], part: &Range<usize>, t: f64, window_s: f64) -> Option<Self> {
        let range = window_samples(t_s, part, t, window_s);
        if range.len() < MIN_READINGS {
            return None;
        }
        let powers = |s: f64| {
            let s = (s - t) / window_s;
            Vector3::new(1.0, s, s * s)
        };
        // Normal equations of the parabola in time scaled by the window, which keeps them well
        // conditioned.
        let mut normal = Matrix3::zeros();
        for s in &t_s[range.clone()] {
            normal.ger(1.0, &powers(*s), &powers(*s), 1.0);
        }
        // At `t` the parabola equals its constant term, so that the weights are the row of the
        // least-squares solution that gives this term.
        let constant = normal.cholesky()?.solve(&Vector3::x());
        let weights = t_s[range.clone()].iter().map(|s| powers(*s).dot(&constant)).collect();
        Some(Self { range, weights })
    }

    /// Returns the value of the fitted parabola of a channel at the time.
    pub fn value(&self, channel: Channel, column: &[f64]) -> f64 {
        let readings = &column[self.range.clone()];
        // Headings are differenced to a reading nearby, so that a jump from 180 to -180 deg does
        // not matter.
        let near = readings[readings.len() / 2];
        let apart = |reading: &f64| match channel {
            Channel::Psi => wrap_angle(reading - near),
            _ => reading - near,
        };
        near + readings.iter().zip(&self.weights).map(|(r, weight)| weight * apart(r)).sum::<f64>()
    }
}

/// Samples of a part in a window about a time; near an end of the part the window is shifted
/// inside.
fn window_samples(t_s: &[f64], part: &Range<usize>, t: f64, window_s: f64) -> Range<usize> {
    let times = &t_s[part.clone()];
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return 0..0 };
    let from = (t - 0.5 * window_s).min(last - window_s).max(*first);
    let rounding = 1e-9 * window_s;
    let low = times.partition_point(|s| *s < from - rounding);
    let high = times.partition_point(|s| *s <= from + window_s + rounding);
    part.start + low..part.start + high
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn times() -> Vec<f64> {
        (0..80).map(|k| 0.1 * f64::from(k) + if k < 40 { 0.0 } else { 7.0 }).collect()
    }

    #[test]
    fn a_parabola_is_left_as_it_is_up_to_its_ends() {
        let t_s = times();
        let column: Vec<f64> = t_s.iter().map(|t| 2.0 - 0.7 * t + 0.3 * t * t).collect();
        for (part, k) in [(0..40, 0), (0..40, 17), (0..40, 39), (40..80, 40)] {
            let about = ReadingsAbout::new(&t_s, &part, t_s[k], 1.0).unwrap();
            assert!((about.value(Channel::U, &column) - column[k]).abs() < 1e-10, "{k}");
            assert!(about.range.start >= part.start && about.range.end <= part.end);
            assert_eq!(about.range.len(), 11, "as long at an end");
        }
    }

    #[test]
    fn scatter_is_less_by_what_its_readings_are_worth() {
        // Of n even readings a parabola in the middle scatters by (9/4)/n of their variance, at an
        // end by 9/n, for many of them.
        let t_s: Vec<f64> = (0..201).map(|k| 0.1 * f64::from(k)).collect();
        let variance = |k: usize| {
            let about = ReadingsAbout::new(&t_s, &(0..201), t_s[k], 10.0).unwrap();
            about.weights.iter().map(|w| w * w).sum::<f64>()
        };
        assert!((variance(100) * 101.0 / 2.25 - 1.0).abs() < 0.05);
        assert!((variance(0) * 101.0 / 9.0 - 1.0).abs() < 0.1);
    }

    #[test]
    fn a_heading_is_smoothed_across_north() {
        let t_s = times();
        let column: Vec<f64> =
            t_s.iter().map(|t| wrap_angle(std::f64::consts::PI + 0.2 * (t - 2.0))).collect();
        let about = ReadingsAbout::new(&t_s, &(0..40), t_s[21], 1.0).unwrap();
        assert!(wrap_angle(about.value(Channel::Psi, &column) - column[21]).abs() < 1e-10);
    }

    #[test]
    fn too_few_readings_are_left_alone() {
        assert!(ReadingsAbout::new(&times(), &(0..40), 1.0, 0.35).is_none());
        assert!(ReadingsAbout::new(&times(), &(38..40), 3.9, 10.0).is_none());
        assert!(ReadingsAbout::new(&[], &(0..0), 0.0, 10.0).is_none());
    }
}
