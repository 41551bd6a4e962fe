//! Outline of a ship on its track, to scale.

use sistership_model::particulars::Particulars;

/// Particulars from which an outline is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullOutline {
    /// Length between perpendiculars, m.
    pub lpp_m: f64,
    /// Beam, m.
    pub beam_m: f64,
}

/// Half of the outline from bow to stern: forward of midship as a fraction of length, to starboard
/// as a fraction of beam. Only length and beam are the ship's own.
const HALF: [(f64, f64); 6] =
    [(0.5, 0.0), (0.42, 0.24), (0.3, 0.44), (0.18, 0.5), (-0.38, 0.5), (-0.5, 0.36)];

impl HullOutline {
    /// Creates the outline of a ship, `None` if length or beam is unknown.
    pub fn from_particulars(particulars: &Particulars) -> Option<Self> {
        let known = |name: &str| particulars.get(name).map(|quantity| quantity.value);
        Some(Self { lpp_m: known("lpp_m")?, beam_m: known("beam_m")? })
    }

    /// Corners of the outline at a position `(north, east)` and heading, m: clockwise from the bow.
    pub fn corners_at(&self, (north, east): (f64, f64), psi_rad: f64) -> Vec<(f64, f64)> {
        let (sin, cos) = psi_rad.sin_cos();
        let starboard = HALF.iter().map(|&(x, y)| (x, y));
        // The port side is the mirror image, from stern to bow, without the bow itself.
        let port = HALF.iter().skip(1).rev().map(|&(x, y)| (x, -y));
        let placed = |(x, y): (f64, f64)| {
            let (forward, right) = (x * self.lpp_m, y * self.beam_m);
            (north + forward * cos - right * sin, east + forward * sin + right * cos)
        };
        starboard.chain(port).map(placed).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bow_points_along_the_heading() {
        let hull = HullOutline { lpp_m: 100.0, beam_m: 20.0 };
        let bow = hull.corners_at((10.0, 20.0), std::f64::consts::FRAC_PI_2)[0];
        assert!((bow.0 - 10.0).abs() < 1e-9 && (bow.1 - 70.0).abs() < 1e-9, "{bow:?}");
        let widest =
            hull.corners_at((0.0, 0.0), 0.0).iter().map(|point| point.1).fold(0.0, f64::max);
        assert!((widest - 10.0).abs() < 1e-9);
    }
}
