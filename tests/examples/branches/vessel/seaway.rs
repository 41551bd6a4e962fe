//! What stands for one year of a ship among waves (Kanazawa 2023, sec. 3.4.2): seas, its motion in
//! them by strips with a roll damping that grows with the motion, and a wave radar's reading. All
//! figures were written down before anything was predicted.

use std::f64::consts::{PI, TAU};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use sistership_learned::seakeeping::{DirectionalSpectrum, WaveHull, WaveMotion};

use super::scenarios::normal;
use super::seas::jonswap;

/// Grid of the radar: 36 directions, 32 frequencies of 0.01 Hz (sec. 3.4.1); the first, none, is
/// left out.
const DIRECTIONS: usize = 36;
const FREQUENCIES: usize = 31;
const STEP_HZ: f64 = 0.01;

/// Significant height: median, m, and deviation of its logarithm; chosen for sheltered waters, so
/// that few samples are large, as the paper says of its own.
const HEIGHT: (f64, f64) = (0.45, 0.7);
/// Steepness of wind seas, 2 pi Hs/(g Tp^2): from that of swell to near breaking (DNV-RP-C205).
const STEEPNESS: [f64; 2] = [1.0 / 60.0, 1.0 / 20.0];
/// Share of swell in the variance, at most, and its peak period, s; chosen.
const SWELL: f64 = 0.4;
const SWELL_S: [f64; 2] = [8.0, 12.0];
/// Exponent of the cosine by which directions spread: DNV-RP-C205 has 2 to 4 for wind seas.
const SPREAD: i32 = 4;
/// Radar: the maker states heights within 10 % (Kanazawa's reference 71); cells by a mean over so
/// many independent ones; direction, rad.
const RADAR_HEIGHT: f64 = 0.10;
const RADAR_CELLS: usize = 8;
const RADAR_RAD: f64 = 0.09;
/// Time over which a motion's deviation is taken, s.
const WATCH_S: f64 = 300.0;
/// Least heave that is kept, m (sec. 3.4.2).
const LEAST_M: f64 = 0.025;

/// What is assumed of the ship: metacentric height chosen, its roll period by the weather criterion
/// of the IMO's code of intact stability (2008, 2.3.4), 2 C B/sqrt(GM) with C = 0.373 + 0.023 B/d -
/// 0.043 L/100; a damping of a tenth, which MSS takes for that of waves.
pub fn assumed() -> WaveHull {
    let (lpp_m, beam_m, draught_m, gm_m): (f64, f64, f64, f64) = (33.9, 9.6, 2.7, 1.5);
    let c = 0.373 + 0.023 * beam_m / draught_m - 0.043 * lpp_m / 100.0;
    WaveHull {
        lpp_m,
        beam_m,
        draught_m,
        block_coefficient: 574_127.69 / 1025.0 / (lpp_m * beam_m * draught_m),
        gm_m,
        roll_period_s: 2.0 * c * beam_m / gm_m.sqrt(),
        roll_damping: 0.1,
        roll_radiation: 0.1,
    }
}

/// A sample: what the radar read and what it did, standard deviations in m, rad, rad.
pub struct Sample {
    pub radar: DirectionalSpectrum,
    pub moved: [f64; 3],
}

/// As many samples as pass the criteria.
pub fn samples(count: usize, seed: u64) -> Vec<Sample> {
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let mut all = Vec::with_capacity(count);
    while all.len() < count {
        let sea = sea(&mut rng);
        let moved = moved(&sea, &mut rng);
        if moved[0] >= LEAST_M {
            all.push(Sample { radar: read(&sea, &mut rng), moved });
        }
    }
    all
}

fn grid() -> (Vec<f64>, Vec<f64>) {
    let omegas = (1..=FREQUENCIES).map(|k| TAU * STEP_HZ * k as f64).collect();
    let betas = (0..DIRECTIONS).map(|k| TAU * k as f64 / DIRECTIONS as f64).collect();
    (omegas, betas)
}

/// A wind sea and swell, each from somewhere.
fn sea(rng: &mut ChaCha12Rng) -> DirectionalSpectrum {
    let height = HEIGHT.0 * (HEIGHT.1 * normal(rng)).exp();
    let period = (TAU * height / (9.80665 * rng.random_range(STEEPNESS[0]..STEEPNESS[1]))).sqrt();
    let share = rng.random_range(0.0..SWELL);
    let parts = [
        (1.0 - share, TAU / period, rng.random_range(0.0..TAU)),
        (share, TAU / rng.random_range(SWELL_S[0]..SWELL_S[1]), rng.random_range(0.0..TAU)),
    ];
    let (omegas, betas) = grid();
    let mut density = vec![vec![0.0; betas.len()]; omegas.len()];
    for (share, peak, towards) in parts {
        let spread = |beta: f64| (0.5 * (beta - towards)).cos().abs().powi(2 * SPREAD);
        let shape = |k: usize, j: usize| jonswap(omegas[k], peak) * spread(betas[j]);
        let cell = TAU * STEP_HZ * TAU / DIRECTIONS as f64;
        let total: f64 =
            (0..omegas.len()).map(|k| (0..betas.len()).map(|j| shape(k, j)).sum::<f64>()).sum();
        let variance = share * height * height / 16.0;
        for (k, row) in density.iter_mut().enumerate() {
            let of = row.iter_mut().enumerate();
            of.for_each(|(j, value)| *value += variance * shape(k, j) / (total * cell));
        }
    }
    DirectionalSpectrum { omegas, betas, density }
}

/// The radar's reading.
fn read(sea: &DirectionalSpectrum, rng: &mut ChaCha12Rng) -> DirectionalSpectrum {
    let scale = (1.0 + RADAR_HEIGHT * normal(rng)).powi(2);
    // Directions by whole cells and the share between two of them.
    let turned = RADAR_RAD * normal(rng) / (TAU / DIRECTIONS as f64);
    let (whole, part) = (turned.floor(), turned - turned.floor());
    let mut read = sea.clone();
    for (row, own) in read.density.iter_mut().zip(&sea.density) {
        for (j, value) in row.iter_mut().enumerate() {
            let at = |k: f64| own[(j as f64 + k).rem_euclid(DIRECTIONS as f64) as usize];
            let mean = (1.0 - part) * at(whole) + part * at(whole + 1.0);
            let noise = (0..RADAR_CELLS).map(|_| -(1.0 - rng.random::<f64>()).ln()).sum::<f64>();
            *value = scale * mean * noise / RADAR_CELLS as f64;
        }
    }
    read
}

/// What it does, with the scatter of so few waves: 1/sqrt(2 n) of n of them.
fn moved(sea: &DirectionalSpectrum, rng: &mut ChaCha12Rng) -> [f64; 3] {
    let truth = TrueShip::new();
    let heave = truth.deviation(sea, WaveMotion::Heave, 0.0);
    let pitch = truth.deviation(sea, WaveMotion::Pitch, 0.0);
    // Damping and motion depend on each other.
    let roll =
        (0..20).fold(0.05, |roll, _| 0.5 * (roll + truth.deviation(sea, WaveMotion::Roll, roll)));
    let waves = WATCH_S / 5.0;
    [heave, pitch, roll].map(|deviation| deviation * (1.0 + normal(rng) / f64::sqrt(2.0 * waves)))
}

/// The ship as it is: strips of an elliptic waterline, other figures than those assumed.
struct TrueShip {
    /// Places along the ship, m, half breadths by the largest.
    strips: Vec<(f64, f64)>,
}

/// Periods of heave, pitch and roll, s: heave and pitch by masses twice its own, roll as of a
/// metacentric height that is a tenth less. Dampings by the critical ones; roll's grows by the
/// motion (Himeno 1981: a linear and a quadratic part), both chosen.
const PERIODS_S: [f64; 3] = [3.9, 3.7, 7.2];
const DAMPINGS: [f64; 3] = [0.35, 0.4, 0.06];
const ROLL_BY_MOTION: f64 = 0.6;
/// Depth of the mean pressure, m, and effective slope in roll; chosen.
const DEPTH_M: f64 = 1.9;
const SLOPE: f64 = 0.75;

impl TrueShip {
    fn new() -> Self {
        let half = 0.5 * 33.9;
        let place = |k: usize| half * ((k as f64 + 0.5) / 10.0 - 1.0);
        let strip = |k: usize| (place(k), (1.0 - (place(k) / half).powi(2)).sqrt());
        Self { strips: (0..20).map(strip).collect() }
    }

    fn deviation(&self, sea: &DirectionalSpectrum, motion: WaveMotion, roll: f64) -> f64 {
        let (rows, step) = (sea.omegas.iter().zip(&sea.density), TAU * STEP_HZ);
        let of_row = |(omega, row): (&f64, &Vec<f64>)| {
            let cells = sea.betas.iter().zip(row);
            cells
                .map(|(beta, density)| density * self.response(motion, *omega, *beta, roll).powi(2))
                .sum::<f64>()
        };
        (step * TAU / DIRECTIONS as f64 * rows.map(of_row).sum::<f64>()).sqrt()
    }

    fn response(&self, motion: WaveMotion, omega: f64, beta: f64, roll: f64) -> f64 {
        let k = omega * omega / 9.80665;
        let (sin, cos) = beta.sin_cos();
        let mean = |of: &dyn Fn(f64) -> f64, weight: &dyn Fn(f64) -> f64| {
            let sum = |with: &dyn Fn(f64) -> f64| -> f64 {
                self.strips.iter().map(|(x, y)| y * with(*x)).sum()
            };
            sum(of) / sum(weight)
        };
        let pressed = (-k * DEPTH_M).exp();
        let (axis, force) = match motion {
            WaveMotion::Heave => (0, pressed * mean(&|x| (k * x * cos).cos(), &|_| 1.0)),
            WaveMotion::Pitch => (1, pressed * mean(&|x| x * (k * x * cos).sin(), &|x| x * x)),
            WaveMotion::Roll => (2, SLOPE * k * sin * mean(&|x| (k * x * cos).cos(), &|_| 1.0)),
        };
        let damping = DAMPINGS[axis] + if axis == 2 { ROLL_BY_MOTION * roll } else { 0.0 };
        let ratio = omega * PERIODS_S[axis] / (2.0 * PI);
        (force / (1.0 - ratio * ratio).hypot(2.0 * damping * ratio)).abs()
    }
}
