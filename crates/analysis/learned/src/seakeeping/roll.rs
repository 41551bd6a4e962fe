//! Roll in regular waves by its natural period and damping: Jensen, Mansour and Olsen 2004 (not
//! seen; read through MSS waveresponse345.m). That file attributes all damping to wave radiation,
//! and omits the length under the root and the wave's phase along the ship; both are included here.

use super::heave_pitch::GRAVITY;
use super::hull::WaveHull;

/// Density of sea water, kg/m3.
const DENSITY: f64 = 1025.0;

/// Roll amplitude per wave amplitude, rad/m. The moment follows from the radiation damping by
/// Haskind's relation, for a section M^2 = (rho g^2/omega) b44; over the length the sections'
/// moments add up as sin(sigma)/sigma.
pub fn roll_response(hull: &WaveHull, omega: f64, beta: f64) -> f64 {
    let WaveHull { lpp_m, beam_m, draught_m, .. } = *hull;
    if omega <= 0.0 {
        return 0.0;
    }
    let volume = hull.block_coefficient * lpp_m * beam_m * draught_m;
    let natural = std::f64::consts::TAU / hull.roll_period_s;
    let restoring = DENSITY * GRAVITY * volume * hull.gm_m;
    let inertia = restoring / (natural * natural);
    let damping = |share: f64| 2.0 * share * natural * inertia;
    // Squared moment of one metre; over the length in phase, the moment is L times the root of
    // that.
    let sectional = DENSITY * GRAVITY * GRAVITY / omega * damping(hull.roll_radiation) / lpp_m;
    let sigma = 0.5 * omega * omega / GRAVITY * beta.cos().abs() * lpp_m;
    let along = if sigma < 1e-6 { 1.0 } else { sigma.sin() / sigma };
    let moment = (beta.sin() * lpp_m * sectional.sqrt() * along).abs();
    // Steady amplitude of a damped oscillator with one degree of freedom.
    moment / (restoring - omega * omega * inertia).hypot(omega * damping(hull.roll_damping))
}
