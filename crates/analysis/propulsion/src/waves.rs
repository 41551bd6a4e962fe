//! Wave resistance of fast hulls, which the friction line leaves out.
//!
//! Residuary resistance by weight rises steeply to the hump at a Froude number of about one half and
//! is level beyond it. The level falls with the slenderness `L/V^(1/3)`.

use crate::slope::UncertainValue;
use crate::thresholds::WAVES;

const GRAVITY: f64 = 9.806_65;

/// Returns the speed of a hull by that of its hump, dimensionless.
pub(crate) fn hump_ratio(length_m: f64, speed_m_s: f64) -> f64 {
    speed_m_s / (GRAVITY * length_m).sqrt() / WAVES.hump
}

/// A hull at a speed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovingHull {
    pub length_m: f64,
    pub displacement_m3: f64,
    pub density_kg_m3: f64,
    pub speed_m_s: f64,
}

impl MovingHull {
    /// Returns its wave resistance, N.
    pub fn wave_resistance(&self) -> UncertainValue {
        let Self { length_m, displacement_m3, density_kg_m3, speed_m_s } = *self;
        let rise = hump_ratio(length_m, speed_m_s).powi(WAVES.rise);
        // A power of the ratio gives the steep rise before the hump, its sum with one the level
        // beyond.
        let slenderness = length_m / displacement_m3.cbrt();
        let level = WAVES.level * (WAVES.slenderness / slenderness).powf(WAVES.slender);
        let weight_n = density_kg_m3 * GRAVITY * displacement_m3;
        let mean = weight_n * level * rise / (1.0 + rise);
        UncertainValue { mean, deviation: WAVES.deviation * mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_are_a_tenth_of_friction_for_a_container_ship_and_most_for_a_boat() {
        let hull = |length_m: f64, displacement_m3: f64, speed_m_s: f64| {
            let density_kg_m3 = 1025.0;
            let hull = MovingHull { length_m, displacement_m3, density_kg_m3, speed_m_s };
            hull.wave_resistance().mean / (density_kg_m3 * GRAVITY * displacement_m3)
        };
        // KCS: the whole resistance is 0.3 % of its weight.
        let slow = hull(230.0, 52_030.0, 12.35);
        assert!((1e-4..6e-4).contains(&slow), "{slow}");
        let fast = hull(8.0, 3.8, 6.0);
        assert!((0.05..0.12).contains(&fast), "{fast}");
        assert!(hull(20.0, 50.0, 11.0) < fast, "slender");
    }
}
