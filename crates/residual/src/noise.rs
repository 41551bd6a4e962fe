//! How much the instruments scatter.

use std::collections::BTreeMap;

use sistership_model::trial::Channel;

use super::TrialReadings;
use super::thresholds::RESIDUAL;

/// What an instrument scatters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instrument {
    /// Standard deviation of the noise of its readings, SI.
    pub deviation: f64,
    /// Root of the density of what its rate and the velocities disagree by, by the root of a
    /// second: headings and positions do not quite follow from velocities.
    pub drift: f64,
}

impl Instrument {
    /// One of which nothing is known but its scatter: the drift keeps a filter from trusting
    /// arithmetic.
    pub fn of_scatter(deviation: f64) -> Self {
        Self { deviation, drift: RESIDUAL.drift * deviation }
    }
}

/// Instruments by channel.
pub type Noise = BTreeMap<Channel, Instrument>;

/// The binomial coefficients of sixth differences; the variance of white noise grows by the sum of
/// their squares.
const SIXTH: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
const GAIN: f64 = 924.0;

/// What sixth differences leave of a ship's motion is far below the noise of any instrument; their
/// median is not moved by the few samples at which something jumps.
pub fn scatter(records: &[TrialReadings<'_>], channel: Channel, every: usize) -> Option<f64> {
    let mut magnitudes: Vec<f64> =
        records.iter().flat_map(|record| differences(record, channel, every)).collect();
    if magnitudes.is_empty() {
        return None;
    }
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of the magnitude of a normal variable is 0.6745 of its standard deviation.
    Some(*median / 0.6745 / GAIN.sqrt())
}

/// Of samples, how many go with one reading: noise must be new in each. Where readings were
/// smoothed, or waves move the ship, velocities wander from sample to sample, and what is smooth
/// would be taken for an acceleration.
pub fn sparseness(records: &[TrialReadings<'_>]) -> usize {
    let grows = |channel: Channel| {
        let pair = scatter(records, channel, 1).zip(scatter(records, channel, RESIDUAL.sparse));
        pair.is_some_and(|(close, apart)| close > 0.0 && apart > RESIDUAL.grows * close)
    };
    if grows(Channel::U) && grows(Channel::V) { RESIDUAL.sparse } else { 1 }
}

fn differences(record: &TrialReadings<'_>, channel: Channel, every: usize) -> Vec<f64> {
    let Some(values) = record.trial.channel(channel) else { return Vec::new() };
    let difference =
        |window: &[usize]| SIXTH.iter().zip(window).map(|(c, &k)| c * values[k]).sum::<f64>().abs();
    let of = |part: &Vec<usize>| {
        let taken: Vec<usize> = part.iter().copied().step_by(every).collect();
        taken.windows(7).map(difference).collect::<Vec<f64>>()
    };
    record.parts.iter().flat_map(of).collect()
}

/// The least noise that is believed of an instrument: noise-free simulations are trials too. By the
/// length of the ship and its speed.
pub fn floor(channel: Channel, lpp_m: f64, speed_m_s: f64) -> f64 {
    let rate = speed_m_s / lpp_m;
    match channel {
        Channel::X | Channel::Y => RESIDUAL.floor * lpp_m,
        Channel::U | Channel::V => RESIDUAL.floor * speed_m_s,
        Channel::R | Channel::P => RESIDUAL.floor * rate,
        _ => RESIDUAL.floor,
    }
}
