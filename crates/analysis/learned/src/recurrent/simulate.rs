//! Simulation with a trained network.

use super::motion::RecordedMotion;
use super::simulated_motion::SimulatedMotion;
use super::training::TrainedNetwork;
use super::windows::ActiveWindows;

impl TrainedNetwork {
    /// Simulates the samples of `own` by Euler's method, the first `given` of them as recorded.
    /// Returns positions and velocities at each. `foundation` returns the accelerations of a
    /// foundation at a sample and simulated velocities, m/s2, m/s2, rad/s2.
    pub fn simulate_motion(
        &self,
        motion: &RecordedMotion,
        own: std::ops::Range<usize>,
        given: usize,
        foundation: &mut dyn FnMut(usize, &[f64; 3]) -> [f64; 3],
    ) -> Vec<([f64; 3], [f64; 3])> {
        let mut run = SimulatedMotion::from_recorded(motion, own.start, given.clamp(1, own.len()));
        let mut windows = ActiveWindows::new(&self.network);
        for (step, k) in own.clone().enumerate() {
            let velocities = run.velocities[step];
            let outputs =
                windows.advance_step(&self.scales.scale_inputs(&velocities, &motion.known[k]));
            // The network also sees the given samples, which fill its memory, but does not advance
            // them.
            if step + 1 >= run.velocities.len() && k + 1 < own.end {
                let law = foundation(k, &velocities);
                let scales = &self.scales.accelerations;
                let sum = std::array::from_fn(|axis| outputs[axis] * scales[axis] + law[axis]);
                run.advance_euler(&sum, motion.interval_s);
            }
        }
        run.positions.into_iter().zip(run.velocities).collect()
    }
}
