//! Steering gear by the recorded movements of the rudder.
//!
//! Standard manoeuvres order a rudder angle; trials record the actual one. The rate of the gear is
//! between them, and does not follow from that of another ship.

use sistership_model::trial::{Channel, Trial};

/// Thresholds of the rate of a gear by a rudder's angle.
#[derive(Debug, Clone, Copy)]
struct SteeringThresholds {
    /// `w/(L/U)`: time over which the rate is taken, by the time in which the ship covers its
    /// length, dimensionless. Source: derived: 35 deg at the least rate of SOLAS II-1/29 take 15 s,
    /// half the time in which a ship of 250 m covers its length at 16 kn; a tenth of that is inside
    /// the movement.
    window: f64,
    /// `s`: share of the largest rate from which a window counts as inside a movement,
    /// dimensionless. Source: derived: windows that begin or end outside by more than a fifth of
    /// their length do not.
    inside: f64,
    /// Angle that a movement at that rate must cover, rad. Source: derived: a rudder that follows
    /// small orders does not show how fast its gear can be; the least order of ITTC 7.5-04-02-01's
    /// zigzags is 10 deg, which from amidships is this twice.
    least_rad: f64,
    /// Standard deviations of an angle's reading that a window at the largest rate must cover,
    /// dimensionless. Source: derived: three deviations of the difference of two readings are then
    /// half of what `inside` leaves, `3 sqrt(2) / 0.1`. At half of it a ship of 129 m at 17 kn, its
    /// rudder read twice a second to 0.09 deg, shows no movement as a whole.
    above_noise: f64,
    /// Most samples in a window. Source: derived: at two samples a second twenty are 10 s, in which
    /// a gear by SOLAS covers the 20 deg of a 10/10 zigzag.
    most_samples: usize,
}

const STEERING: SteeringThresholds = SteeringThresholds {
    window: 0.05,
    inside: 0.8,
    least_rad: 0.0873,
    above_noise: 42.0,
    most_samples: 20,
};

/// Returns the gear's rate, rad/s, by the fastest movements of the rudder in trials; none where no
/// movement is long enough to show it. `length_s` is the time in which the ship covers its length.
pub fn measured_rate(trials: &[&Trial], length_s: f64) -> Option<f64> {
    let of = |trial: &&Trial| {
        let step_s = trial.interval_s();
        let count = ((STEERING.window * length_s / step_s).round() as usize).max(1);
        rates_above_noise(trial, count)
    };
    let each: Vec<Vec<(f64, f64)>> = trials.iter().map(of).collect();
    let largest = largest_rate(each.iter().flatten());
    // Movements are runs of windows whose rate is near the largest one.
    let is_inside = |(rate, _): &(f64, f64)| largest > 0.0 && *rate >= STEERING.inside * largest;
    let movements =
        each.iter().flat_map(|rates| rates.chunk_by(|a, b| is_inside(a) == is_inside(b)));
    // A short movement may end before the gear reaches its rate.
    let covered = |movement: &&[(f64, f64)]| {
        movement.iter().map(|(rate, step_s)| rate * step_s).sum::<f64>() >= STEERING.least_rad
    };
    let long = movements.filter(|movement| movement.first().is_some_and(is_inside)).filter(covered);
    let mut inside: Vec<f64> = long.flatten().map(|(rate, _)| *rate).collect();
    inside.sort_by(f64::total_cmp);
    // The median, which single windows with large noise do not move.
    inside.get(inside.len() / 2).copied()
}

/// Rates of the rudder over windows of so many samples that begin at each sample, each with the
/// time to the next sample.
fn rudder_rates(trial: &Trial, count: usize) -> Vec<(f64, f64)> {
    let Some(angle) = trial.channel(Channel::Delta) else { return Vec::new() };
    let step_s = trial.interval_s();
    let pairs = (count..angle.len()).map(|end| (end - count, end));
    let rate = |(from, to): (usize, usize)| {
        let time_s = trial.t_s[to] - trial.t_s[from];
        // Across a gap the movement is unknown.
        let whole = time_s < 1.5 * count as f64 * step_s;
        whole.then(|| ((angle[to] - angle[from]).abs() / time_s, step_s))
    };
    pairs.filter_map(rate).collect()
}

/// Rates over windows of at least `count` samples, long enough that the largest rate is
/// significantly above the noise.
fn rates_above_noise(trial: &Trial, count: usize) -> Vec<(f64, f64)> {
    let needed_rad = STEERING.above_noise * noise_rad(trial);
    let stands_out = |count: &usize, rates: &[(f64, f64)]| {
        largest_rate(rates.iter()) * *count as f64 * trial.interval_s() >= needed_rad
    };
    let tried =
        (count..=STEERING.most_samples.max(count)).map(|count| (count, rudder_rates(trial, count)));
    // The shortest window that suffices is used.
    let found = tried.into_iter().find(|(count, rates)| stands_out(count, rates));
    found.map(|(_, rates)| rates).unwrap_or_default()
}

fn largest_rate<'a>(rates: impl Iterator<Item = &'a (f64, f64)>) -> f64 {
    rates.map(|(rate, _)| *rate).fold(0.0, f64::max)
}

/// Standard deviation of the noise of a rudder's readings, rad: by the median of their second
/// differences, as most of the time there is no movement. White noise of deviation s has second
/// differences of sqrt(6) s, and a normal variable's median size is 0.6745 deviations.
fn noise_rad(trial: &Trial) -> f64 {
    let Some(angle) = trial.channel(Channel::Delta) else { return 0.0 };
    let mut second: Vec<f64> =
        angle.windows(3).map(|at| (at[0] - 2.0 * at[1] + at[2]).abs()).collect();
    second.sort_by(f64::total_cmp);
    second.get(second.len() / 2).map_or(0.0, |median| median / (0.6745 * 6.0_f64.sqrt()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha12Rng;
    use rand_distr::StandardNormal;

    use super::*;

    /// A rudder that goes to 20 deg and over to the other side, read with noise.
    fn zigzag(rate_deg_s: f64, noise_deg: f64, orders: &[f64]) -> Trial {
        let mut rng = ChaCha12Rng::seed_from_u64(5);
        let (mut angle, mut t_s, mut read) = (0.0_f64, Vec::new(), Vec::new());
        for k in 0..400 {
            let order = orders[k / 100 % orders.len()];
            let noise: f64 = rng.sample(StandardNormal);
            t_s.push(0.5 * k as f64);
            read.push((angle + noise_deg * noise).to_radians());
            angle += (order - angle).clamp(-0.5 * rate_deg_s, 0.5 * rate_deg_s);
        }
        Trial { channels: [(Channel::Delta, read)].into(), t_s, ..Trial::default() }
    }

    #[test]
    fn the_rate_is_that_of_the_gear_whatever_the_noise() {
        for (rate, noise) in [(2.32, 0.0), (2.32, 0.1), (4.0, 0.1), (5.0, 0.3)] {
            let trial = zigzag(rate, noise, &[20.0, -20.0]);
            let measured = measured_rate(&[&trial], 30.0).unwrap().to_degrees();
            assert!((measured / rate - 1.0).abs() < 0.1, "{rate} deg/s read as {measured}");
        }
    }

    #[test]
    fn a_short_ship_shows_its_rate_within_the_noise() {
        for rate in [2.32, 2.9, 3.8] {
            let trial = zigzag(rate, 0.09, &[20.0, -20.0]);
            let measured = measured_rate(&[&trial], 14.7).unwrap();
            let measured = measured.to_degrees();
            assert!((measured / rate - 1.0).abs() < 0.03, "{rate} deg/s read as {measured}");
        }
    }

    #[test]
    fn a_rudder_that_hardly_moves_shows_no_rate() {
        let trial = zigzag(5.0, 0.05, &[1.0, -1.0]);
        assert_eq!(measured_rate(&[&trial], 30.0), None);
        assert_eq!(measured_rate(&[&Trial::default()], 30.0), None);
    }
}
