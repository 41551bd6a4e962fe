//! Linear derivatives by regression: Clarke, Gedling and Hine (1983), The application of
//! manoeuvring criteria in hull design using linear theory, Transactions RINA 125, 45-68.

use super::dimensions::Dimensions;

/// Derivatives in the prime system of `rho L^2 U / 2` and so on; origin at midship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivatives {
    /// Sway force by sway velocity.
    pub y_v: f64,
    /// Sway force by yaw rate.
    pub y_r: f64,
    /// Yaw moment by sway velocity.
    pub n_v: f64,
    /// Yaw moment by yaw rate.
    pub n_r: f64,
    /// Sway force by sway acceleration.
    pub y_vdot: f64,
    /// Sway force by yaw acceleration.
    pub y_rdot: f64,
    /// Yaw moment by sway acceleration.
    pub n_vdot: f64,
    /// Yaw moment by yaw acceleration.
    pub n_rdot: f64,
}

/// The regression, each with the factor `-pi (T/L)^2`:
/// `Y_v: 1 + 0.40 C_B B/T`, `Y_r: -1/2 + 2.2 B/L - 0.080 B/T`,
/// `N_v: 1/2 + 2.4 T/L`, `N_r: 1/4 + 0.039 B/T - 0.56 B/L`,
/// `Y_vdot: 1 + 0.16 C_B B/T - 5.1 (B/L)^2`, `Y_rdot: 0.67 B/L - 0.0033 (B/T)^2`,
/// `N_vdot: 1.1 B/L - 0.041 B/T`, `N_rdot: 1/12 + 0.017 C_B B/T - 0.33 B/L`.
pub fn derivatives(ship: &Dimensions) -> Derivatives {
    let slender = -std::f64::consts::PI * (ship.draught_m / ship.lpp_m).powi(2);
    let wide = ship.beam_m / ship.draught_m;
    let stout = ship.beam_m / ship.lpp_m;
    let full = ship.block_coefficient * wide;
    Derivatives {
        y_v: slender * (1.0 + 0.40 * full),
        y_r: slender * (-0.5 + 2.2 * stout - 0.080 * wide),
        n_v: slender * (0.5 + 2.4 * ship.draught_m / ship.lpp_m),
        n_r: slender * (0.25 + 0.039 * wide - 0.56 * stout),
        y_vdot: slender * (1.0 + 0.16 * full - 5.1 * stout.powi(2)),
        y_rdot: slender * (0.67 * stout - 0.0033 * wide.powi(2)),
        n_vdot: slender * (1.1 * stout - 0.041 * wide),
        n_rdot: slender * (1.0 / 12.0 + 0.017 * full - 0.33 * stout),
    }
}
