//! A learned correction with its weights, ready for evaluation at every step of a simulation.

use sistership_model::branch::{Branch, BranchMode, BranchOutput};
use sistership_model::coefficient::Axis;
use sistership_simulation::branch::{AdditionFormulas, AdditionGradient, Instant, LearnedBranch};

use crate::answer::{MOST_INPUTS, answer};
use crate::domain::FadedDomain;
use crate::formula::formulas;
use crate::gradient::OutputGradient;
use crate::regressor::Regressor;
use crate::weights::Weights;

/// A learned correction with its weights.
#[derive(Debug, Clone)]
pub struct Learned {
    mode: BranchMode,
    outputs: Vec<(usize, BranchOutput, Regressor)>,
    domain: FadedDomain,
}

impl Learned {
    /// Creates a correction from its document and weights. Returns `None` if the domain bounds
    /// channels that a correction does not have, or if an output has more inputs than there are
    /// signals.
    pub fn of(branch: &Branch, weights: Weights) -> Option<Self> {
        let domain = FadedDomain::of(&branch.domain, branch.fade)?;
        let place = |axis: Axis| [Axis::X, Axis::Y, Axis::N].iter().position(|a| *a == axis);
        let one = |(output, regressor): (&BranchOutput, Regressor)| {
            let few = output.inputs.len() <= MOST_INPUTS;
            few.then_some((place(output.axis)?, output.clone(), regressor))
        };
        let outputs = branch.outputs.iter().zip(weights.outputs).map(one).collect::<Option<_>>()?;
        Some(Self { mode: branch.mode, outputs, domain })
    }

    /// Domain in which the correction acts, with its fading.
    pub fn domain(&self) -> &FadedDomain {
        &self.domain
    }
}

impl LearnedBranch for Learned {
    fn share(&self, instant: &Instant) -> f64 {
        self.domain.share(instant)
    }

    fn addition(&self, instant: &Instant) -> [f64; 3] {
        let (mut added, share) = ([0.0; 3], self.domain.share(instant));
        if share == 0.0 {
            return added;
        }
        for (place, output, regressor) in &self.outputs {
            let answer = answer(output, regressor, instant);
            // A converting or serial correction predicts the whole acceleration, so the law's own
            // value is subtracted from it.
            let replaced = match self.mode {
                BranchMode::Parallel => 0.0,
                BranchMode::Convert | BranchMode::Serial => instant.accelerations[*place],
            };
            added[*place] = share * (answer - replaced);
        }
        added
    }

    fn gradient(&self, instant: &Instant) -> AdditionGradient {
        let mut gradient = AdditionGradient::default();
        let share = self.domain.share(instant);
        if share == 0.0 {
            return gradient;
        }
        // Product rule: the share depends on the motion, too.
        let by_share = self.domain.gradient(instant);
        for (place, output, regressor) in &self.outputs {
            let replaces = self.mode != BranchMode::Parallel;
            let own =
                OutputGradient::new(output, regressor, instant).joined(replaces, instant, *place);
            own.add_to(&mut gradient, *place, (share, &by_share));
        }
        gradient
    }

    fn formulas(&self) -> AdditionFormulas {
        formulas(self.mode, &self.outputs, &self.domain)
    }
}
