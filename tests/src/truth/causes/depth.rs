//! Shallow water by factors on the hull's forces after Taimuri et al. (2020), Ocean Engineering,
//! doi
//! 10.1016/j.oceaneng.2020.108103 (not seen; read through pymaneuvering, `_shallow_water_hdm`,
//! where those of the drag stand; here they serve the linear forces too): polynomials of the depth
//! below the keel and of `C_B B (1 + B/L)^2 / T`. The library's forms are other formulas.

use super::super::clarke::derivatives;
use super::super::cross_flow::CrossFlow;
use super::super::dimensions::Dimensions;

/// A depth for all trials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// Draught by water depth.
    pub draught_to_depth: f64,
}

/// Drag of the part of the hull that the factor multiplies, chosen as that of the ships here.
const CROSS_FLOW: CrossFlow = CrossFlow { drag: 0.7, ends: 0.5, bow: 0.1 };

/// Factors on what follows drift in sway, drift in yaw, the yaw rate in yaw, and on the drag
/// across.
struct Factors {
    y_v: f64,
    n_v: f64,
    n_r: f64,
    across: f64,
}

impl Depth {
    /// With `H` the depth below the keel by draught, `K_0 = 1 + 0.0775/H^2 - 0.011/H^3 +
    /// 0.000068/H^5`, `K_1 = -0.0643/H + 0.0724/H^2 - 0.0113/H^3 + 0.0000767/H^5`, `K_2 = 0.0342/H`
    /// up to `B/T = 4`.
    fn factors(&self, ship: &Dimensions) -> Factors {
        let below = 1.0 / self.draught_to_depth - 1.0;
        let over = |power: i32| below.powi(power).recip();
        let k0 = 1.0 + 0.0775 * over(2) - 0.011 * over(3) + 0.000068 * over(5);
        let k1 = -0.0643 * over(1) + 0.0724 * over(2) - 0.0113 * over(3) + 0.0000767 * over(5);
        let k2 = 0.0342 * over(1);
        let full = ship.block_coefficient * ship.beam_m * (1.0 + ship.beam_m / ship.lpp_m).powi(2)
            / ship.draught_m;
        let of = |first: f64, second: f64| k0 + first * k1 * full + second * k2 * full.powi(2);
        let n_r = of(1.0 / 2.0, 1.0 / 3.0);
        Factors { y_v: 1.5 * n_r - 0.5, n_v: of(1.0, 1.0), n_r, across: of(2.0 / 3.0, 8.0 / 15.0) }
    }

    /// Surge, sway (N) and yaw (N m) beyond those in deep water, at velocities through it: the
    /// linear ones by Clarke's regression, and drag across.
    pub fn forces(&self, ship: &Dimensions, [u, v, r]: [f64; 3]) -> [f64; 3] {
        let d = derivatives(ship);
        let factors = self.factors(ship);
        let area = 0.5 * ship.density_kg_m3 * ship.lpp_m.powi(2) * u.abs();
        let drag = CROSS_FLOW.forces(ship, v, r).map(|force| (factors.across - 1.0) * force);
        let y = area * (factors.y_v - 1.0) * d.y_v * v;
        let of_drift = (factors.n_v - 1.0) * d.n_v * v;
        let of_rate = (factors.n_r - 1.0) * d.n_r * ship.lpp_m * r;
        [0.0, y + drag[0], area * ship.lpp_m * (of_drift + of_rate) + drag[1]]
    }
}
