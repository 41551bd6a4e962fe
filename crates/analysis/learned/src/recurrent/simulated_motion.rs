//! Simulation by Euler's method, through which networks are trained.

use super::motion::RecordedMotion;

/// Simulated states of a sequence, sample by sample.
pub struct SimulatedMotion {
    pub positions: Vec<[f64; 3]>,
    pub velocities: Vec<[f64; 3]>,
}

impl SimulatedMotion {
    /// Starts a simulation with the first `given` samples as recorded.
    pub fn from_recorded(motion: &RecordedMotion, start: usize, given: usize) -> Self {
        let own = start..start + given;
        Self {
            positions: motion.positions[own.clone()].to_vec(),
            velocities: motion.velocities[own].to_vec(),
        }
    }

    /// Advances the simulation by one step: Eqs. 21 to 23.
    pub fn advance_euler(&mut self, acceleration: &[f64; 3], dt: f64) {
        let last = self.velocities.len() - 1;
        let ([x, y, psi], [u, v, r]) = (self.positions[last], self.velocities[last]);
        let (sin, cos) = psi.sin_cos();
        self.positions.push([
            x + dt * (u * cos - v * sin),
            y + dt * (u * sin + v * cos),
            psi + dt * r,
        ]);
        self.velocities.push(std::array::from_fn(|axis| {
            self.velocities[last][axis] + dt * acceleration[axis]
        }));
    }
}
