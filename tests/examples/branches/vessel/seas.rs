//! Long-crested waves by the JONSWAP spectrum, and the motion of wave frequency that instruments
//! read with the rest.

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

use super::hull::Hull;
use super::weather::Weather;

const GRAVITY: f64 = 9.80665;
/// Components, between shares of the peak's frequency.
const COMPONENTS: usize = 24;
const BAND: [f64; 2] = [0.6, 2.6];
/// Peakedness of the mean JONSWAP spectrum.
const GAMMA: f64 = 3.3;

/// A wave: amplitude, frequency, number, phase.
struct Wave {
    amplitude_m: f64,
    omega: f64,
    number: f64,
    phase: f64,
}

/// Waves of one direction.
pub struct Seas {
    waves: Vec<Wave>,
    towards_rad: f64,
}

/// Spectral density by that of the peak (Hasselmann and others 1973), up to a factor.
pub fn jonswap(omega: f64, peak: f64) -> f64 {
    let width = if omega <= peak { 0.07 } else { 0.09 };
    let near = (-(omega - peak).powi(2) / (2.0 * (width * peak).powi(2))).exp();
    omega.powi(-5) * (-1.25 * (peak / omega).powi(4)).exp() * GAMMA.powf(near)
}

impl Seas {
    pub fn new(weather: &Weather, seed: u64) -> Self {
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        let peak = TAU / weather.period_s;
        let step = (BAND[1] - BAND[0]) * peak / COMPONENTS as f64;
        let omegas: Vec<f64> = (0..COMPONENTS)
            .map(|k| BAND[0] * peak + (k as f64 + rng.random::<f64>()) * step)
            .collect();
        let total: f64 = omegas.iter().map(|omega| jonswap(*omega, peak)).sum();
        // Variance of the elevation is Hs^2/16, of a wave a^2/2.
        let share = |omega: f64| jonswap(omega, peak) / total * weather.height_m.powi(2) / 16.0;
        let wave = |omega: f64| Wave {
            amplitude_m: (2.0 * share(omega)).sqrt(),
            omega,
            number: omega * omega / GRAVITY,
            phase: TAU * rng.random::<f64>(),
        };
        Self { waves: omegas.into_iter().map(wave).collect(), towards_rad: weather.towards_rad }
    }

    /// What they move a ship at a place and time: north, east (m), heading (rad). The water's own
    /// motion at the surface, as a mean over the hull's extent along the waves.
    pub fn motion(&self, hull: &Hull, t_s: f64, [north, east, psi]: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = self.towards_rad.sin_cos();
        let (across, along) = (self.towards_rad - psi).sin_cos();
        let extent = hull.lpp_m * along.abs() + hull.beam_m * across.abs();
        let (mut moved, mut turned) = (0.0, 0.0);
        for wave in &self.waves {
            let phase = wave.number * (north * cos + east * sin) - wave.omega * t_s + wave.phase;
            let mean = sinc(0.5 * wave.number * extent);
            moved -= wave.amplitude_m * mean * phase.sin();
            let slope = wave.amplitude_m * wave.number * mean;
            turned += slope * across * along * phase.cos();
        }
        [moved * cos, moved * sin, turned]
    }
}

fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-6 { 1.0 } else { x.sin() / x }
}
