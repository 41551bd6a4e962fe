//! Roll in regular waves by its natural period and damping: Jensen, Mansour and Olsen 2004 (not
//! seen; read through MSS waveresponse345.m). That file takes all of the damping for what makes
//! waves, and leaves out the length under the root and the wave's phase along the ship; here are
//! both.

use super::heave_pitch::GRAVITY;
use super::hull::WaveHull;

/// Density of sea water, kg/m3.
const DENSITY: f64 = 1025.0;

/// rad/m. The moment follows from the damping by waves, by Haskind's relation: a section that
/// radiates waves when it rolls is rolled by them, M^2 = (rho g^2/omega) b44; over the length the
/// sections' moments add up as sin(sigma)/sigma.
pub fn roll(hull: &WaveHull, omega: f64, beta: f64) -> f64 {
    let WaveHull { lpp_m, beam_m, draught_m, .. } = *hull;
    if omega <= 0.0 {
        return 0.0;
    }
    let volume = hull.block_coefficient * lpp_m * beam_m * draught_m;
    let natural = std::f64::consts::TAU / hull.roll_period_s;
    let restoring = DENSITY * GRAVITY * volume * hull.gm_m;
    let inertia = restoring / (natural * natural);
    let damping = |share: f64| 2.0 * share * natural * inertia;
    // Of one metre; over the length in phase, that is L times the root of a metre's.
    let sectional = DENSITY * GRAVITY * GRAVITY / omega * damping(hull.roll_radiation) / lpp_m;
    let sigma = 0.5 * omega * omega / GRAVITY * beta.cos().abs() * lpp_m;
    let along = if sigma < 1e-6 { 1.0 } else { sigma.sin() / sigma };
    let moment = (beta.sin() * lpp_m * sectional.sqrt() * along).abs();
    moment / (restoring - omega * omega * inertia).hypot(omega * damping(hull.roll_damping))
}
