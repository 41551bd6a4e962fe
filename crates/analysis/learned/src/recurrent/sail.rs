//! Simulation with a trained network.

use super::motion::Motion;
use super::simulated::Simulated;
use super::training::Fit;
use super::windows::Windows;

impl Fit {
    /// Simulates the samples of `own` by Euler's method, the first `given` of them as recorded.
    /// Returns positions and velocities at each. `foundation` returns the accelerations of a
    /// foundation at a sample and simulated velocities, m/s2, m/s2, rad/s2.
    pub fn sail(
        &self,
        motion: &Motion,
        own: std::ops::Range<usize>,
        given: usize,
        foundation: &mut dyn FnMut(usize, &[f64; 3]) -> [f64; 3],
    ) -> Vec<([f64; 3], [f64; 3])> {
        let mut run = Simulated::begin(motion, own.start, given.clamp(1, own.len()));
        let mut windows = Windows::new(&self.network);
        for (step, k) in own.clone().enumerate() {
            let velocities = run.velocities[step];
            let outputs = windows.step(&self.scales.inputs(&velocities, &motion.known[k]));
            // The network also sees the given samples, which fill its memory, but does not advance
            // them.
            if step + 1 >= run.velocities.len() && k + 1 < own.end {
                let law = foundation(k, &velocities);
                let scales = &self.scales.accelerations;
                let sum = std::array::from_fn(|axis| outputs[axis] * scales[axis] + law[axis]);
                run.advance(&sum, motion.interval_s);
            }
        }
        run.positions.into_iter().zip(run.velocities).collect()
    }
}
