//! The filter against steady states that are known in closed form.
#![allow(clippy::unwrap_used)]

use sistership_model::trial::Channel;
use sistership_model::uncertainty::Discrepancy;

use super::super::filter::whiten_part;
use super::super::linearised::{LinearisationSizes, RateResponse};
use super::super::noise::NoiseLevel;
use super::super::thresholds::RESIDUAL;
use super::*;

/// Samples after which nothing changes any more.
const LONG: usize = 400;

/// Variance of a reading, and by which its state walks in a second.
const READING: f64 = 0.09;
const WALK: f64 = 0.04;

/// A record of one reading a second; the first state is a velocity.
fn record(samples: usize, states: usize, channel: (Channel, usize)) -> LinearisedPart {
    let mut slopes = vec![0.0; states * states];
    if states == 2 {
        // The second state is the integral of the first.
        slopes[2] = 1.0;
    }
    LinearisedPart {
        samples: (0..samples).collect(),
        t_s: (0..samples).map(|k| k as f64).collect(),
        sizes: LinearisationSizes { states, axes: 1, columns: 0 },
        jacobian: slopes.repeat(samples),
        accelerations: Vec::new(),
        defect: vec![0.0; states * samples],
        reading: vec![0.0; samples],
        by_state: None,
        by_column: Vec::new(),
        measured: Vec::new(),
        by_rate: Vec::new(),
        channels: vec![channel],
        every: 1,
    }
}

fn noise(channel: Channel, walk: f64) -> InstrumentNoise {
    let instrument = NoiseLevel { deviation: READING.sqrt(), drift: walk.sqrt() };
    std::iter::once((channel, instrument)).collect()
}

fn discrepancy(white: f64) -> AxisDiscrepancies {
    vec![Discrepancy { deviation: 1e-9, time_s: 1.0, white: white.sqrt() }]
}

/// The variance of the last innovation.
fn last_variance(of: &dyn Fn(usize) -> f64) -> f64 {
    (of(LONG) - of(LONG - 1)).exp()
}

/// Innovations, not whitened, from a unit in one late reading on.
fn after_unit(
    mut part: LinearisedPart,
    by: (&InstrumentNoise, &AxisDiscrepancies),
    variance: f64,
) -> [f64; 3] {
    let at = LONG - 3;
    part.reading[at] = 1.0;
    let rows = whiten_part(&part, by.0, by.1).unwrap().0;
    std::array::from_fn(|k| rows[at + k] * variance.sqrt())
}

fn assert_near(own: f64, closed: f64) {
    assert!((own - closed).abs() < 1e-9 * (1.0 + closed.abs()), "{own} not {closed}");
}

/// `P^2 - q P - q r = 0` of the predicted variance; the gain is `P/(P + r)`.
#[test]
fn a_random_walk_has_its_steady_gain() {
    let velocity = (Channel::U, 0);
    // What the instrument drifts and what the acceleration scatters are the same to a walk.
    for share in [0.0, 0.25, 1.0] {
        let by = (&noise(Channel::U, share * WALK), &discrepancy((1.0 - share) * WALK));
        let of = |samples: usize| whiten_part(&record(samples, 1, velocity), by.0, by.1).unwrap().1;
        let predicted = 0.5 * (WALK + (WALK * WALK + 4.0 * WALK * READING).sqrt());
        let variance = predicted + READING;
        assert_near(last_variance(&of), variance);
        let gain = predicted / variance;
        let innovations = after_unit(record(LONG, 1, velocity), by, variance);
        let closed = [1.0, -gain, -gain * (1.0 - gain)];
        innovations.iter().zip(closed).for_each(|(own, closed)| assert_near(*own, closed));
    }
}

/// In the middle of a long record the variance of a walk by all readings is the integral of
/// `q r/(q + r (2 - 2 cos w))` over all frequencies, `q r/sqrt(q^2 + 4 q r)`.
#[test]
fn a_random_walk_has_its_smoothed_variance() {
    let by = (&noise(Channel::U, WALK), &discrepancy(0.0));
    let all = smoothed_states(&record(LONG, 1, (Channel::U, 0)), by.0, by.1).unwrap();
    let closed = WALK * READING / (WALK * WALK + 4.0 * WALK * READING).sqrt();
    assert_near(all[LONG / 2].covariance[(0, 0)], closed);
    let last = 0.5 * (WALK + (WALK * WALK + 4.0 * WALK * READING).sqrt());
    assert_near(all[LONG - 1].covariance[(0, 0)], last * READING / (last + READING));
}

/// A position that is read of a velocity that walks: with `z = u + 1/u` and `u^2` the variance of
/// an innovation by that of a reading, `z^2 - 4 = sqrt(q/r) z`; the gains are `1 - 1/u^2` and
/// `sqrt(q/r)/u`.
#[test]
fn a_constant_velocity_has_its_steady_gains() {
    let position = (Channel::X, 1);
    let by = (&noise(Channel::X, 0.0), &discrepancy(WALK));
    let of = |samples: usize| whiten_part(&record(samples, 2, position), by.0, by.1).unwrap().1;
    let index = (WALK / READING).sqrt();
    let z = 0.5 * (index + (index * index + 16.0).sqrt());
    let u = 0.5 * (z + (z * z - 4.0).sqrt());
    let variance = READING * u * u;
    assert_near(last_variance(&of), variance);
    let (position_gain, velocity_gain) = (1.0 - 1.0 / (u * u), index / u);
    let innovations = after_unit(record(LONG, 2, position), by, variance);
    let first = position_gain + velocity_gain;
    assert_near(innovations[0], 1.0);
    assert_near(innovations[1], -first);
    // Its own innovation corrects both before the second.
    let second = position_gain + 2.0 * velocity_gain - first * (position_gain + velocity_gain);
    assert_near(innovations[2], -second);
}

/// An instrument that is late says less by its delay times the rate that the filter expects.
#[test]
fn a_late_instrument_follows_the_rate_that_is_expected() {
    let (delay, slope, samples) = (0.7, -0.2, 5);
    let mut part = record(samples, 1, (Channel::U, 0));
    part.jacobian.fill(slope);
    part.reading = vec![0.5, 0.4, 0.1, -0.3, 0.2];
    let by = (&noise(Channel::U, WALK), &discrepancy(WALK));
    let response = RateResponse { channel: 0, column: None, state: 0, by: vec![-delay; samples] };
    let late = LinearisedPart { by_rate: vec![response], ..part.clone() };
    // By hand: the covariance is that of a reading without delay.
    let (mut mean, mut variance) = (0.0, (RESIDUAL.start * READING.sqrt()).powi(2));
    let rows = whiten_part(&late, by.0, by.1).unwrap().0;
    let transition = 1.0 + slope + 0.5 * slope * slope;
    for (k, row) in rows.iter().enumerate() {
        if k > 0 {
            mean *= transition;
            variance = transition * variance * transition + 2.0 * WALK;
        }
        let error = part.reading[k] - mean + delay * slope * mean;
        assert_near(*row, error / (variance + READING).sqrt());
        let gain = variance / (variance + READING);
        mean += gain * error;
        variance -= gain * variance;
    }
}
