//! How much the instruments scatter.

use std::collections::BTreeMap;

use sistership_model::trial::Channel;

use super::Record;

/// Standard deviation of the noise by channel, SI.
pub type Noise = BTreeMap<Channel, f64>;

/// The binomial coefficients of sixth differences; the variance of white noise grows by the sum of their squares.
const SIXTH: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
const GAIN: f64 = 924.0;

/// What sixth differences leave of a ship's motion is far below the noise of any instrument; their median is not moved
/// by the few samples at which something jumps.
pub fn scatter(records: &[Record<'_>], channel: Channel) -> Option<f64> {
    let mut magnitudes: Vec<f64> = records.iter().flat_map(|record| differences(record, channel)).collect();
    if magnitudes.is_empty() {
        return None;
    }
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of the magnitude of a normal variable is 0.6745 of its standard deviation.
    Some(*median / 0.6745 / GAIN.sqrt())
}

fn differences(record: &Record<'_>, channel: Channel) -> Vec<f64> {
    let Some(values) = record.trial.channel(channel) else { return Vec::new() };
    let difference = |window: &[usize]| SIXTH.iter().zip(window).map(|(c, &k)| c * values[k]).sum::<f64>().abs();
    record.parts.iter().flat_map(|part| part.windows(7).map(difference).collect::<Vec<_>>()).collect()
}

/// The least noise that is believed of an instrument: noise-free simulations are trials too. By the length of the ship
/// and her speed.
pub fn floor(channel: Channel, lpp_m: f64, speed_m_s: f64) -> f64 {
    let rate = speed_m_s / lpp_m;
    match channel {
        Channel::X | Channel::Y => 1e-5 * lpp_m,
        Channel::U | Channel::V => 1e-5 * speed_m_s,
        Channel::R | Channel::P => 1e-5 * rate,
        _ => 1e-5,
    }
}
