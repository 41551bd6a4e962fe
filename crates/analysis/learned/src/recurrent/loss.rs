//! Loss of one sequence and its gradient: on positions and velocities that the network simulates
//! (Wakita 2022, Eq. 24), or on accelerations (Eq. 17).

use super::loss_gradient::LossGradient;
use super::motion::RecordedMotion;
use super::network::{NetworkMemory, RecurrentNetwork, UnrolledNetwork};
use super::scales::MotionScales;
use super::sequence::{LossKind, SequenceTraining};
use super::simulated_motion::SimulatedMotion;

/// Network in training, with the settings of its loss.
pub struct SequenceLoss<'a> {
    pub network: &'a RecurrentNetwork,
    pub scales: &'a MotionScales,
    pub training: &'a SequenceTraining,
}

impl SequenceLoss<'_> {
    /// Loss of the sequence that starts at a sample, and its gradient with respect to the network's
    /// parameters.
    pub fn with_gradient(&self, motion: &RecordedMotion, start: usize) -> (f64, Vec<f64>) {
        match self.training.loss {
            LossKind::States => self.state_loss(motion, start),
            LossKind::Accelerations => self.acceleration_loss(motion, start),
        }
    }

    /// Number of recorded steps that fill the memory: Eq. 20.
    fn given_steps(&self) -> usize {
        match self.network.shape.memory {
            NetworkMemory::Steps(steps) => steps,
            NetworkMemory::All => 1,
        }
    }

    /// Evaluates the network over the past that it sees at a step.
    fn unroll_step(&self, inputs: &[Vec<f64>], step: usize) -> UnrolledNetwork {
        let from = self.network.memory_start(step);
        self.network.unroll_steps(inputs[from..=step].iter().map(Vec::as_slice))
    }

    /// Loss on accelerations (Eq. 17) and its gradient.
    fn acceleration_loss(&self, motion: &RecordedMotion, start: usize) -> (f64, Vec<f64>) {
        let steps = self.training.steps;
        let inputs: Vec<Vec<f64>> = (start..start + steps)
            .map(|k| self.scales.scale_inputs(&motion.velocities[k], &motion.known[k]))
            .collect();
        let mut gradient = vec![0.0; self.network.numbers.len()];
        let mut loss = 0.0;
        // The first steps only fill the memory.
        for step in self.given_steps() - 1..steps {
            let unrolled = self.unroll_step(&inputs, step);
            let measured = motion.unexplained_acceleration(start + step);
            let blame: Vec<f64> = (0..3)
                .map(|axis| {
                    unrolled.outputs[axis] - measured[axis] / self.scales.accelerations[axis]
                })
                .collect();
            loss += blame.iter().map(|x| x * x).sum::<f64>() / steps as f64;
            // Derivative of the mean of squares.
            let blame: Vec<f64> = blame.iter().map(|x| 2.0 * x / steps as f64).collect();
            self.network.propagate_back(&unrolled, &blame, &mut gradient);
        }
        (loss, gradient)
    }

    /// Loss on states (Eq. 24) of a simulation by Euler's method, and its gradient back through the
    /// simulation.
    fn state_loss(&self, motion: &RecordedMotion, start: usize) -> (f64, Vec<f64>) {
        let (run, unrolled) = self.simulate_sequence(motion, start);
        let share = 1.0 / (self.training.steps - self.given_steps() + 1) as f64;
        let blame = LossGradient::from_states(&run, motion, start, self.scales, share);
        (blame.loss, self.propagate_back(&run, &unrolled, blame, motion.interval_s))
    }

    /// Simulates a sequence. Also returns the intermediate values of the network at each step,
    /// `None` at the given ones.
    fn simulate_sequence(
        &self,
        motion: &RecordedMotion,
        start: usize,
    ) -> (SimulatedMotion, Vec<Option<UnrolledNetwork>>) {
        let steps = self.training.steps;
        let mut run = SimulatedMotion::from_recorded(motion, start, self.given_steps());
        let mut inputs: Vec<Vec<f64>> = Vec::with_capacity(steps);
        let mut unrolled: Vec<Option<UnrolledNetwork>> = Vec::with_capacity(steps);
        for step in 0..steps {
            inputs
                .push(self.scales.scale_inputs(&run.velocities[step], &motion.known[start + step]));
            if step + 1 < self.given_steps() {
                // Recorded states follow, so the network need not be evaluated.
                unrolled.push(None);
                continue;
            }
            let one = self.unroll_step(&inputs, step);
            // The network gives scaled accelerations on top of those of the foundation.
            let own = |axis: usize| one.outputs[axis] * self.scales.accelerations[axis];
            let acceleration =
                std::array::from_fn(|axis| own(axis) + motion.given[start + step][axis]);
            run.advance_euler(&acceleration, motion.interval_s);
            unrolled.push(Some(one));
        }
        (run, unrolled)
    }

    /// Propagates the derivatives of the loss back through all steps (backpropagation through
    /// time).
    fn propagate_back(
        &self,
        run: &SimulatedMotion,
        unrolled: &[Option<UnrolledNetwork>],
        mut blame: LossGradient,
        dt: f64,
    ) -> Vec<f64> {
        let mut gradient = vec![0.0; self.network.numbers.len()];
        for step in (self.given_steps() - 1..self.training.steps).rev() {
            // First through the kinematics to the step before; then the velocity at the next step
            // gives the derivative of the accelerations, and with it of the network's parameters
            // and inputs.
            blame.propagate_step(run, step, dt);
            let outputs: Vec<f64> = (0..3)
                .map(|axis| dt * blame.velocities[step + 1][axis] * self.scales.accelerations[axis])
                .collect();
            let Some(one) = &unrolled[step] else { continue };
            let from = self.network.memory_start(step);
            for (back, seen) in
                self.network.propagate_back(one, &outputs, &mut gradient).iter().enumerate()
            {
                // The inputs are velocities divided by their scales, of every step in the memory.
                let at = &mut blame.velocities[from + back];
                let scaled = seen.iter().zip(&self.scales.velocities);
                at.iter_mut().zip(scaled).for_each(|(at, (seen, scale))| *at += seen / scale);
            }
        }
        gradient
    }
}
