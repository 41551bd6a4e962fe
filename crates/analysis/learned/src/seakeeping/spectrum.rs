//! Directional wave spectra, as measured by a wave radar, and the motions of a ship in them.

use serde::{Deserialize, Serialize};

use super::response::{ResponseOperator, WaveMotion};

/// Variance density of the wave elevation by frequency and direction, m2 s/rad.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectionalSpectrum {
    /// Frequencies, rad/s, equally spaced.
    pub omegas: Vec<f64>,
    /// Directions of wave travel relative to the bow, rad, equally spaced around the ship.
    pub betas: Vec<f64>,
    /// Densities by frequency, then by direction.
    pub density: Vec<Vec<f64>>,
}

impl DirectionalSpectrum {
    /// Variance of the elevation, m2.
    pub fn variance_m2(&self) -> f64 {
        self.weighted_integral(|_, _| 1.0)
    }

    /// Standard deviation of a motion, m or rad: Kanazawa 2023, Eqs. 2.12, 2.13 and 3.7.
    pub fn motion_deviation(&self, ship: &impl ResponseOperator, motion: WaveMotion) -> f64 {
        self.weighted_integral(|omega, beta| ship.response_amplitude(motion, omega, beta).powi(2))
            .sqrt()
    }

    /// Integral of the spectrum, weighted by a function of frequency and direction.
    fn weighted_integral(&self, of: impl Fn(f64, f64) -> f64) -> f64 {
        let apart = |all: &[f64]| if all.len() > 1 { all[1] - all[0] } else { 0.0 };
        // The grid is equally spaced in both directions, so every cell has the same size.
        let cell = apart(&self.omegas) * apart(&self.betas);
        let row = |(omega, row): (&f64, &Vec<f64>)| {
            let cells = self.betas.iter().zip(row);
            cells.map(|(beta, density)| density * of(*omega, *beta)).sum::<f64>()
        };
        cell * self.omegas.iter().zip(&self.density).map(row).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seakeeping::hull::GUNNERUS;

    /// Long waves: it rides them, heave is the elevation and roll its slope.
    #[test]
    fn in_long_waves_the_ship_follows_the_surface() {
        let hull = GUNNERUS;
        let (omega, beam) = (0.15, std::f64::consts::FRAC_PI_2);
        let slope = omega * omega / 9.80665;
        assert!((hull.response_amplitude(WaveMotion::Heave, omega, beam) - 1.0).abs() < 0.01);
        let pitch = hull.response_amplitude(WaveMotion::Pitch, omega, std::f64::consts::PI);
        assert!((pitch / slope - 1.0).abs() < 0.05, "{}", pitch / slope);
        assert!(hull.response_amplitude(WaveMotion::Pitch, omega, beam) < 1e-12);
        assert!(hull.response_amplitude(WaveMotion::Roll, omega, 0.0) < 1e-12);
    }

    /// Of one direction and one frequency: variance by response squared.
    #[test]
    fn a_narrow_sea_gives_the_response_there() {
        let betas: Vec<f64> = (0..36).map(|k| (10.0 * f64::from(k)).to_radians()).collect();
        let omegas: Vec<f64> = (0..32).map(|k| 0.2 + 0.1 * f64::from(k)).collect();
        let mut density = vec![vec![0.0; 36]; 32];
        density[5][9] = 2.0;
        let spectrum = DirectionalSpectrum { omegas, betas, density };
        let expected = 2.0 * 0.1 * 10.0_f64.to_radians();
        assert!((spectrum.variance_m2() - expected).abs() < 1e-12);
    }
}
