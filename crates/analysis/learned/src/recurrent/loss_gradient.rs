//! Gradient of the loss on simulated states, and its propagation back through a simulation.

use super::motion::RecordedMotion;
use super::scales::MotionScales;
use super::simulated_motion::SimulatedMotion;

/// Loss and its derivatives with respect to each simulated state.
pub struct LossGradient {
    pub loss: f64,
    pub positions: Vec<[f64; 3]>,
    pub velocities: Vec<[f64; 3]>,
}

impl LossGradient {
    /// Computes the weighted squared differences between a simulation and the recorded motion, and
    /// their derivatives with respect to the simulated states.
    pub fn from_states(
        run: &SimulatedMotion,
        motion: &RecordedMotion,
        start: usize,
        scales: &MotionScales,
        share: f64,
    ) -> Self {
        let mut loss = 0.0;
        let mut one = |simulated: &[f64; 3], recorded: &[f64; 3], scales: &[f64; 3]| {
            std::array::from_fn(|axis| {
                // Each difference is divided by the scale of its state.
                let off = (simulated[axis] - recorded[axis]) / scales[axis];
                loss += share * off * off;
                2.0 * share * off / scales[axis]
            })
        };
        let (mut positions, mut velocities) = (Vec::new(), Vec::new());
        for k in 0..run.velocities.len() {
            let there = start + k;
            positions.push(one(&run.positions[k], &motion.positions[there], &scales.positions));
            velocities.push(one(&run.velocities[k], &motion.velocities[there], &scales.velocities));
        }
        Self { loss, positions, velocities }
    }

    /// Adds to the derivatives at a step those that act through the next step: the transposed
    /// Jacobian of Eqs. 21 to 23.
    pub fn propagate_step(&mut self, run: &SimulatedMotion, step: usize, dt: f64) {
        let ([_, _, psi], [u, v, _]) = (run.positions[step], run.velocities[step]);
        let (sin, cos) = psi.sin_cos();
        // Derivatives at the next step. Euler's method has state(k + 1) = state(k) + dt
        // f(state(k)), hence the identity plus dt times the Jacobian of the kinematics.
        let ([x, y, heading], next) = (self.positions[step + 1], self.velocities[step + 1]);
        let at = &mut self.positions[step];
        at[0] += x;
        at[1] += y;
        at[2] += heading + dt * (x * (-u * sin - v * cos) + y * (u * cos - v * sin));
        let at = &mut self.velocities[step];
        at[0] += next[0] + dt * (x * cos + y * sin);
        at[1] += next[1] + dt * (y * cos - x * sin);
        at[2] += next[2] + dt * heading;
    }
}
