//! What is learned beside a law of motion, as a simulation takes it.

/// What a learned branch sees of an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// u, v, r: m/s, m/s, rad/s.
    pub velocities: [f64; 3],
    /// Rudder angle, rad; 0 for a law without one.
    pub delta_rad: f64,
    /// Propeller revolutions, 1/s; 0 for a law without them.
    pub n_rps: f64,
    /// The rates of u, v, r that the law gives, its foundation: m/s2, m/s2, rad/s2.
    pub accelerations: [f64; 3],
}

/// Something learned that changes the accelerations of a ship in surge, sway and yaw.
///
/// It must keep its additions bounded, and give none outside what it was trained on.
pub trait LearnedBranch: std::fmt::Debug + Send + Sync {
    /// What is added to the rates of u, v, r: m/s2, m/s2, rad/s2.
    fn addition(&self, instant: &Instant) -> [f64; 3];
}
