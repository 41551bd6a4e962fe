//! Spiral tests: MSC/Circ.1053, appendix 4, 2; ITTC 7.5-04-02-01.

use serde::{Deserialize, Serialize};

/// Rudder angle and yaw rate of a turn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpiralPoint {
    /// Rudder, deg, positive to starboard.
    pub rudder_deg: f64,
    /// Yaw rate, deg/s.
    pub rate_deg_s: f64,
    /// True if the motion had become steady when the next rudder angle, or rate, was ordered.
    pub steady: bool,
}

/// Metrics of the direct and the reverse spiral.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpiralMetrics {
    /// The direct spiral (Dieudonné): the rudder from starboard to port and back, in this order.
    pub direct: Vec<SpiralPoint>,
    /// The reverse spiral (Bech): yaw rates held by the rudder, from port to starboard.
    pub reverse: Vec<SpiralPoint>,
    /// Width of the loop by the direct spiral, deg of rudder: between the angles at which it
    /// changes sides on the way to port and back, each known to a step of the rudder.
    pub direct_loop_width_deg: f64,
    /// Width of the loop by the reverse spiral, deg of rudder; 0 for a ship that is stable on a
    /// straight course.
    pub loop_width_deg: f64,
    /// Height of the loop: yaw rate from one side to the other with the rudder amidships, deg/s.
    pub loop_height_deg_s: f64,
    /// Largest acceptable width at this length and speed, deg: not a criterion of MSC.137(76), but
    /// of classification societies.
    pub width_limit_deg: f64,
}

impl SpiralMetrics {
    /// Evaluates points in the order of their simulation; `length_s` is length over speed, s.
    pub fn from_points(direct: Vec<SpiralPoint>, reverse: Vec<SpiralPoint>, length_s: f64) -> Self {
        Self {
            direct_loop_width_deg: direct_loop_width(&direct),
            loop_width_deg: reverse_loop_width(&reverse),
            loop_height_deg_s: loop_height(&direct),
            width_limit_deg: width_limit(length_s),
            direct,
            reverse,
        }
    }

    /// Returns true if the ship is stable on a straight course, which means that there is no loop.
    pub fn is_stable(&self) -> bool {
        self.loop_width_deg < SMALLEST_LOOP_DEG
    }
}

/// Smallest width of a loop, deg of rudder: five times the resolution of the rudder at a held rate
/// (0.02 deg). At half and double of it the verdicts of docs/evidence/manoeuvres.md are the same.
const SMALLEST_LOOP_DEG: f64 = 0.1;

/// Acceptable width of the loop, deg: none below L/V = 9 s, 12 deg above 45 s, (L/V)/3 - 3 between
/// (American Bureau of Shipping 2006, Guide for vessel maneuverability, sec. 2; its text was not at
/// hand).
pub fn width_limit(length_s: f64) -> f64 {
    (length_s / 3.0 - 3.0).clamp(0.0, 12.0)
}

/// Returns the difference of the rudder angles at which the yaw rate changes its sign on the way to
/// port and back, deg.
fn direct_loop_width(points: &[SpiralPoint]) -> f64 {
    // The smallest rudder angle separates the way to port from the way back.
    let least = points.iter().enumerate().min_by(|a, b| a.1.rudder_deg.total_cmp(&b.1.rudder_deg));
    let Some((turned, _)) = least else { return 0.0 };
    let changes = |way: &[SpiralPoint]| {
        let pair = way.windows(2).find(|pair| pair[0].rate_deg_s * pair[1].rate_deg_s <= 0.0)?;
        Some(0.5 * (pair[0].rudder_deg + pair[1].rudder_deg))
    };
    let (there, back) = (changes(&points[..=turned]), changes(&points[turned..]));
    there.zip(back).map_or(0.0, |(there, back)| (back - there).max(0.0))
}

/// Returns the range of rudder angles against the turn that hold small yaw rates, from side to
/// side, deg.
fn reverse_loop_width(points: &[SpiralPoint]) -> f64 {
    // In a loop, rates to port are held by a rudder to starboard of that of rates to starboard.
    let port = points.iter().filter(|point| point.rate_deg_s <= 0.0);
    let starboard = points.iter().filter(|point| point.rate_deg_s >= 0.0);
    let most = port.map(|point| point.rudder_deg).fold(f64::NEG_INFINITY, f64::max);
    let least = starboard.map(|point| point.rudder_deg).fold(f64::INFINITY, f64::min);
    if most.is_finite() && least.is_finite() { (most - least).max(0.0) } else { 0.0 }
}

/// Returns the difference of the yaw rates with the rudder amidships on the way to port and back,
/// deg/s.
fn loop_height(points: &[SpiralPoint]) -> f64 {
    let amidships = points.iter().filter(|point| point.rudder_deg.abs() < 0.05);
    let rates: Vec<f64> = amidships.map(|point| point.rate_deg_s).collect();
    // Amidships is passed once on each way; other counts belong to an incomplete spiral.
    match rates[..] {
        [there, back] => (there - back).abs(),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(all: &[(f64, f64)]) -> Vec<SpiralPoint> {
        let one = |&(rudder_deg, rate_deg_s): &(f64, f64)| SpiralPoint {
            rudder_deg,
            rate_deg_s,
            steady: true,
        };
        all.iter().map(one).collect()
    }

    #[test]
    fn an_unstable_ship_has_a_loop() {
        // The rudder that a yaw rate needs: r^3 - r, its extremes 2/(3 sqrt 3) at r = 1/sqrt 3.
        let held: Vec<(f64, f64)> =
            (-200..=200).map(|k| f64::from(k) / 100.0).map(|r| (r * r * r - r, r)).collect();
        let direct = points(&[(1.0, 1.3), (0.0, 1.0), (-1.0, -1.3), (0.0, -1.0), (1.0, 1.3)]);
        let spiral = SpiralMetrics::from_points(direct, points(&held), 30.0);
        assert!((spiral.loop_width_deg - 4.0 / 27_f64.sqrt()).abs() < 1e-3, "{spiral:?}");
        assert_eq!((spiral.direct_loop_width_deg, spiral.loop_height_deg_s), (1.0, 2.0));
        assert_eq!(spiral.width_limit_deg, 7.0);
    }

    #[test]
    fn a_stable_ship_has_none() {
        let held = points(&[(-3.0, -1.0), (-1.0, -0.5), (0.2, 0.0), (1.0, 0.5), (3.0, 1.0)]);
        let direct = points(&[(1.0, 0.5), (0.0, 0.0), (-1.0, -0.5), (0.0, 0.0), (1.0, 0.5)]);
        let spiral = SpiralMetrics::from_points(direct, held, 5.0);
        assert_eq!((spiral.loop_width_deg, spiral.loop_height_deg_s), (0.0, 0.0));
        assert_eq!((width_limit(5.0), width_limit(60.0)), (0.0, 12.0));
    }
}
