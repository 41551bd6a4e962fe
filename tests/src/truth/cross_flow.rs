//! Drag of the flow across the hull, strip by strip: Faltinsen (1990), Sea Loads on Ships and
//! Offshore Structures, chapter 6; its distribution over the length after Hooft (1994), The
//! cross-flow drag on a manoeuvring ship, Ocean Engineering 21, 329-342.

use super::dimensions::Dimensions;

/// Strips of equal length.
const STRIPS: usize = 20;

/// Drag coefficient over the length: `C_D (1 + ends xi^2 + bow xi)` with `xi = 2 x / L`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossFlow {
    /// Coefficient at midship: 0.4 to 1 for hulls with rounded bilges.
    pub drag: f64,
    /// How much more the ends have, where the section separates at both edges.
    pub ends: f64,
    /// How much more the bow has than the stern.
    pub bow: f64,
}

impl CrossFlow {
    /// Sway force (N) and yaw moment (N m) at sway velocity `v` and yaw rate `r`:
    /// `Y = -rho/2 T sum C_D |v + x r| (v + x r) dx`, `N` with the lever `x`.
    pub fn forces(&self, ship: &Dimensions, v: f64, r: f64) -> [f64; 2] {
        let width = ship.lpp_m / STRIPS as f64;
        let scale = 0.5 * ship.density_kg_m3 * ship.draught_m * width;
        (0..STRIPS).fold([0.0; 2], |[force, moment], strip| {
            let xi = (2.0 * strip as f64 + 1.0) / STRIPS as f64 - 1.0;
            let x = 0.5 * ship.lpp_m * xi;
            let across = v + x * r;
            let of_strip = -scale * self.at(xi) * across * across.abs();
            [force + of_strip, moment + x * of_strip]
        })
    }

    fn at(&self, xi: f64) -> f64 {
        self.drag * (1.0 + self.ends * xi * xi + self.bow * xi)
    }
}
