//! Wind by cross-flow and drag: Blendermann, W. (1994), Parameter identification of wind loads on
//! ships, J. Wind Eng. Ind. Aerodyn. 51, 339-351; read through blendermann94.m of the Marine
//! Systems Simulator.

use std::f64::consts::FRAC_PI_2;

use super::wind::Areas;

/// `C_Dt`, `C_Dl` by the frontal area from ahead and from astern, `delta`: of a loaded container
/// ship and of a loaded tanker.
const CONTAINER: [f64; 4] = [0.90, 0.55, 0.55, 0.40];
const TANKER: [f64; 4] = [0.70, 0.90, 0.55, 0.40];

/// Coefficients as [`super::isherwood::coefficients`] gives them, `sin` and `cos` those of the
/// angle `g`: `C_X = -C_Dl cos g / d`, `C_Y = C_Dt sin g / d`, `C_N = (s_L/L - 0.18 (g - pi/2))
/// C_Y` with `d = 1 - delta/2 (1 - C_Dl A_F / (C_Dt A_L)) sin^2 2g`.
pub fn coefficients(areas: &Areas, angle_rad: f64) -> [f64; 3] {
    let [across, bow, stern, delta] = if areas.is_tanker { TANKER } else { CONTAINER };
    let along = if angle_rad <= FRAC_PI_2 { bow } else { stern };
    let ratio = along * areas.frontal_m2 / (areas.lateral_m2 * across);
    let reduced = 1.0 - 0.5 * delta * (1.0 - ratio) * (2.0 * angle_rad).sin().powi(2);
    let y = across * angle_rad.sin() / reduced;
    let lever = 0.5 - areas.centroid - 0.18 * (angle_rad - FRAC_PI_2);
    [-along * angle_rad.cos() / reduced, y, lever * y]
}
