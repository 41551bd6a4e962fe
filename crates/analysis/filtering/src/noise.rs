//! Noise of the instruments.

use std::collections::BTreeMap;

use sistership_model::trial::Channel;

use super::TrialReadings;
use super::thresholds::RESIDUAL;

/// Noise of an instrument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseLevel {
    /// Standard deviation of the noise of its readings, SI.
    pub deviation: f64,
    /// Root of the density of the disagreement between its rate and the velocities, by the root of
    /// a second: headings and positions do not quite follow from velocities.
    pub drift: f64,
}

impl NoiseLevel {
    /// Creates an instrument of which only the noise is known, with the default drift.
    pub fn from_deviation(deviation: f64) -> Self {
        Self { deviation, drift: RESIDUAL.drift * deviation }
    }
}

/// Instruments by channel.
pub type InstrumentNoise = BTreeMap<Channel, NoiseLevel>;

/// Binomial coefficients of sixth differences; the variance of white noise grows by the sum of
/// their squares.
const SIXTH: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
const GAIN: f64 = 924.0;

/// Standard deviation of a channel's noise by sixth differences, SI; none without seven consecutive
/// readings. The remainder of a ship's motion in sixth differences is far below the noise of any
/// instrument. `every` gives the stride among the samples of each trial.
pub fn noise_deviation(
    records: &[TrialReadings<'_>],
    channel: Channel,
    every: &dyn Fn(&TrialReadings<'_>) -> usize,
) -> Option<f64> {
    let of = |record| used_differences(record, channel, every(record));
    deviation_from_differences(records.iter().flat_map(of).collect())
}

/// Standard deviation of noise by magnitudes of its sixth differences. Their median is robust
/// against the few samples at which a reading jumps.
fn deviation_from_differences(mut magnitudes: Vec<f64>) -> Option<f64> {
    if magnitudes.is_empty() {
        return None;
    }
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of the magnitude of a normal variable is 0.6745 of its standard deviation.
    Some(*median / 0.6745 / GAIN.sqrt())
}

/// Interval between readings with independent noise, s; none where the noise of all samples is
/// white. Where readings were smoothed, or waves move the ship, velocities wander from sample to
/// sample, and an acceleration would be inferred from smooth noise.
///
/// White noise has the same deviation at any spacing. It is compared with that of adjacent recorded
/// samples: the samples that a linearisation uses are further apart for slower ships, and with
/// their spacing the same recorder would seem to smooth one set of trials and not another.
pub fn reading_interval(records: &[TrialReadings<'_>]) -> Option<f64> {
    let ratio = |channel: Channel| {
        let recorded = |record: &TrialReadings<'_>| recorded_differences(record, channel);
        let close = deviation_from_differences(records.iter().flat_map(recorded).collect())?;
        let apart = noise_deviation(records, channel, &|_| RESIDUAL.sparse)?;
        (close > 0.0).then(|| apart / close)
    };
    let is_smoothed = |channel: Channel| ratio(channel).is_some_and(|r| r > RESIDUAL.smoothed);
    let interval_s = RESIDUAL.sparse as f64 * records.iter().find_map(TrialReadings::step_s)?;
    // Times are kept to the microsecond.
    let rounded_s = (1e6 * interval_s).round() / 1e6;
    [Channel::U, Channel::V].into_iter().all(is_smoothed).then_some(rounded_s)
}

/// Stride of readings with independent noise, as [`reading_interval`] but among the samples that
/// are used, a count. Models without a stored interval read trials by it.
pub fn reading_stride(records: &[TrialReadings<'_>]) -> usize {
    let grows = |channel: Channel| {
        let of = |every: usize| noise_deviation(records, channel, &|_| every);
        let pair = of(1).zip(of(RESIDUAL.sparse));
        pair.is_some_and(|(close, apart)| close > 0.0 && apart > RESIDUAL.grows * close)
    };
    if grows(Channel::U) && grows(Channel::V) { RESIDUAL.sparse } else { 1 }
}

fn used_differences(record: &TrialReadings<'_>, channel: Channel, every: usize) -> Vec<f64> {
    let taken = |part: &Vec<usize>| part.iter().copied().step_by(every).collect();
    sixth_differences(record, channel, &taken)
}

/// Sixth differences of every recorded sample, also between those that are used.
fn recorded_differences(record: &TrialReadings<'_>, channel: Channel) -> Vec<f64> {
    let between = |part: &Vec<usize>| (part[0]..=part[part.len() - 1]).collect();
    sixth_differences(record, channel, &between)
}

fn sixth_differences(
    record: &TrialReadings<'_>,
    channel: Channel,
    taken: &dyn Fn(&Vec<usize>) -> Vec<usize>,
) -> Vec<f64> {
    let Some(values) = record.trial.channel(channel) else { return Vec::new() };
    let difference =
        |window: &[usize]| SIXTH.iter().zip(window).map(|(c, &k)| c * values[k]).sum::<f64>().abs();
    let of = |part| taken(part).windows(7).map(difference).collect::<Vec<f64>>();
    record.parts.iter().flat_map(of).collect()
}

/// Least noise of an instrument, SI, by the ship's length and speed: noise-free simulations are
/// trials too.
pub fn noise_floor(channel: Channel, lpp_m: f64, speed_m_s: f64) -> f64 {
    let rate = speed_m_s / lpp_m;
    match channel {
        Channel::X | Channel::Y => RESIDUAL.floor * lpp_m,
        Channel::U | Channel::V | Channel::UWater | Channel::VWater => RESIDUAL.floor * speed_m_s,
        Channel::R | Channel::P => RESIDUAL.floor * rate,
        _ => RESIDUAL.floor,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sistership_model::Trial;

    /// Pseudo-random numbers from -1/2 to 1/2.
    fn white(count: usize) -> Vec<f64> {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) - 0.5
        };
        (0..count).map(|_| next()).collect()
    }

    /// What a recorder of second order makes of it, whose time constants are so many samples.
    fn smoothed(noise: &[f64], samples: f64) -> Vec<f64> {
        smoothed_once(&smoothed_once(noise, samples), samples)
    }

    fn smoothed_once(noise: &[f64], samples: f64) -> Vec<f64> {
        let mut level = 0.0;
        let mut next = |new: &f64| {
            level += (new - level) / samples;
            level
        };
        noise.iter().map(&mut next).collect()
    }

    /// A turn at 10 Hz whose velocities have this noise.
    fn trial(noise: &[f64]) -> Trial {
        let t_s: Vec<f64> = (0..noise.len()).map(|k| 0.1 * k as f64).collect();
        let with_noise = |motion: &dyn Fn(f64) -> f64| -> Vec<f64> {
            t_s.iter().zip(noise).map(|(t, noise)| motion(*t) + 0.01 * noise).collect()
        };
        let u = with_noise(&|t| 1.0 - 0.2 * (0.05 * t).sin());
        let v = with_noise(&|t| 0.2 * (0.05 * t).cos());
        let channels = [(Channel::U, u), (Channel::V, v)].into();
        Trial { t_s, channels, ..Trial::default() }
    }

    fn interval_s(trial: &Trial, least_step_s: f64) -> Option<f64> {
        reading_interval(&[TrialReadings::new(trial, least_step_s, 0.0)])
    }

    #[test]
    fn white_noise_is_new_in_every_sample() {
        let trial = trial(&white(4000));
        assert_eq!([0.1, 0.2, 0.3].map(|step_s| interval_s(&trial, step_s)), [None; 3]);
    }

    /// By neighbours among the samples that are used, these are smoothed at one spacing and white
    /// at another.
    #[test]
    fn smoothed_readings_are_so_at_whichever_spacing_samples_are_used() {
        let trial = trial(&smoothed(&white(4000), 4.0));
        let near = |step_s: f64, interval: f64| {
            let found = interval_s(&trial, step_s).expect("smoothed");
            assert!((found - interval).abs() < 1e-9, "{step_s}: {found}");
        };
        near(0.1, 0.5);
        near(0.2, 1.0);
        near(0.4, 2.0);
        let used = |step_s| reading_stride(&[TrialReadings::new(&trial, step_s, 0.0)]);
        assert_eq!([used(0.1), used(0.4)], [5, 1], "which the samples that are used do not say");
    }
}
