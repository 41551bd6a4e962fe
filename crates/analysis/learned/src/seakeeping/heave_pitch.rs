//! Heave and pitch of a box in regular waves: Jensen, Mansour and Olsen 2004, Ocean Engineering 31,
//! 61-85 (the paper was not seen; read through MSS waveresponse345.m), at zero speed, where the
//! encounter frequency is that of the wave.

use super::hull::WaveHull;

/// Acceleration of gravity, m/s2.
pub const GRAVITY: f64 = 9.80665;

/// Common factors of heave and pitch.
struct BoxResponse {
    /// Wave number, 1/m.
    k: f64,
    /// Half the ship length in wave phase: k_e L/2.
    sigma: f64,
    /// Forcing kappa f: decay of the pressure, and correction for the disturbed wave.
    force: f64,
    /// Amplification eta of the oscillator.
    enlarged: f64,
}

impl BoxResponse {
    /// Computes the factors for a wave of frequency `omega`, rad/s, in direction `beta`, rad.
    fn in_wave(hull: &WaveHull, omega: f64, beta: f64) -> Self {
        let k = omega * omega / GRAVITY;
        // A box of the same displacement: its breadth is the ship's beam times the block
        // coefficient.
        let breadth = k * hull.beam_m * hull.block_coefficient;
        let (effective, draught) = (k * beta.cos().abs(), k * hull.draught_m);
        // A = 2 sin(kB/2) exp(-kT), the ratio of radiated to own amplitude of a section.
        let radiated = 2.0 * (0.5 * breadth).sin() * (-draught).exp();
        let damping = radiated * radiated / breadth.max(1e-12);
        Self {
            k,
            sigma: 0.5 * effective * hull.lpp_m,
            force: (-effective * hull.draught_m).exp() * (1.0 - draught).hypot(damping),
            enlarged: 1.0 / (1.0 - 2.0 * draught).hypot(damping),
        }
    }
}

/// Heave amplitude per wave amplitude, m/m.
pub fn heave_response(hull: &WaveHull, omega: f64, beta: f64) -> f64 {
    let BoxResponse { sigma, force, enlarged, .. } = BoxResponse::in_wave(hull, omega, beta);
    (enlarged * force * sinc(sigma)).abs()
}

/// Pitch amplitude per wave amplitude, rad/m.
pub fn pitch_response(hull: &WaveHull, omega: f64, beta: f64) -> f64 {
    let BoxResponse { k, sigma, force, enlarged } = BoxResponse::in_wave(hull, omega, beta);
    if k == 0.0 {
        return 0.0;
    }
    // (6/L)(1/sigma)(sin(sigma)/sigma - cos(sigma)), which goes as sigma/3 towards a beam sea.
    let lever = if sigma < 1e-3 { sigma / 3.0 } else { (sinc(sigma) - sigma.cos()) / sigma };
    (enlarged * force * 6.0 / hull.lpp_m * lever).abs()
}

fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-6 { 1.0 } else { x.sin() / x }
}
