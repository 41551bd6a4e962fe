//! Hull derivatives by regression on the particulars: Yoshimura and Masumoto (2012), Hydrodynamic
//! database and manoeuvring prediction method with medium high-speed merchant ships and fishing
//! vessels, MARSIM. The paper was not at hand; these are the formulas that public implementations
//! carry under its name (github.com/nikpau/mmgdynamics, `dynamics.py`, whose equations of motion
//! are those of the law `mmg`, and two collections of regressions in Matlab, which agree but for
//! the added masses).

use std::collections::BTreeMap;
use std::f64::consts::PI;

/// What the regressions take.
#[derive(Debug, Clone, Copy)]
pub struct Hull {
    pub lpp_m: f64,
    pub beam_m: f64,
    pub draught_m: f64,
    pub block_coefficient: f64,
}

/// The hull derivatives by name; `m_x` and `m_y` are the added masses, which the regressions of
/// `X_vr` and `Y_r` hold.
pub fn derivatives(hull: Hull, m_x: f64, m_y: f64) -> BTreeMap<&'static str, f64> {
    let Hull { lpp_m, beam_m, draught_m, block_coefficient: c_b } = hull;
    let (slender, full) = (lpp_m / beam_m, c_b * beam_m / lpp_m);
    let k = 2.0 * draught_m / lpp_m;
    let fine = (1.0 - c_b) * slender;
    BTreeMap::from([
        ("X_vv", 1.15 * full - 0.18),
        ("X_vr", m_y - 1.91 * full + 0.08),
        ("X_rr", -0.085 * full + 0.008),
        ("X_vvvv", -6.68 * full + 1.1),
        ("Y_v", -(0.5 * PI * k + 1.4 * full)),
        ("Y_r", m_x + 0.5 * full),
        ("Y_vvv", -0.185 * slender + 0.48),
        ("Y_vvr", -0.75),
        ("Y_vrr", -(0.26 * fine + 0.11)),
        ("Y_rrr", -0.051),
        ("N_v", -k),
        ("N_r", -0.54 * k + k * k),
        ("N_vvv", 0.69 * c_b - 0.66),
        ("N_vvr", 1.55 * full - 0.76),
        ("N_vrr", -0.075 * fine - 0.098),
        ("N_rrr", 0.25 * full - 0.056),
    ])
}
