//! A learned correction with its weights, ready for evaluation at every step of a simulation.

use sistership_model::branch::{CorrectionDocument, CorrectionMode, CorrectionOutput};
use sistership_model::coefficient::Axis;
use sistership_simulation::branch::{
    AdditionFormulas, AdditionGradient, CorrectionInstant, CorrectionModel,
};

use crate::answer::{MOST_INPUTS, predict_output};
use crate::domain::FadedDomain;
use crate::formula::addition_formulas;
use crate::gradient::OutputGradient;
use crate::regressor::OutputRegressor;
use crate::weights::CorrectionWeights;

/// A learned correction with its weights.
#[derive(Debug, Clone)]
pub struct LearnedCorrection {
    mode: CorrectionMode,
    outputs: Vec<(usize, CorrectionOutput, OutputRegressor)>,
    domain: FadedDomain,
}

impl LearnedCorrection {
    /// Creates a correction from its document and weights. Returns `None` if the domain bounds
    /// channels that a correction does not have, or if an output has more inputs than there are
    /// signals.
    pub fn from_branch(branch: &CorrectionDocument, weights: CorrectionWeights) -> Option<Self> {
        let domain = FadedDomain::from_region(&branch.domain, branch.fade)?;
        let place = |axis: Axis| [Axis::X, Axis::Y, Axis::N].iter().position(|a| *a == axis);
        let one = |(output, regressor): (&CorrectionOutput, OutputRegressor)| {
            let few = output.inputs.len() <= MOST_INPUTS;
            few.then_some((place(output.axis)?, output.clone(), regressor))
        };
        let outputs = branch.outputs.iter().zip(weights.outputs).map(one).collect::<Option<_>>()?;
        Some(Self { mode: branch.mode, outputs, domain })
    }

    /// Domain in which the correction acts, with its fading.
    pub fn faded_domain(&self) -> &FadedDomain {
        &self.domain
    }
}

impl CorrectionModel for LearnedCorrection {
    fn active_share(&self, instant: &CorrectionInstant) -> f64 {
        self.domain.share_at(instant)
    }

    fn rate_additions(&self, instant: &CorrectionInstant) -> [f64; 3] {
        let (mut added, share) = ([0.0; 3], self.domain.share_at(instant));
        if share == 0.0 {
            return added;
        }
        for (place, output, regressor) in &self.outputs {
            let answer = predict_output(output, regressor, instant);
            // A converting or serial correction predicts the whole acceleration, so the law's own
            // value is subtracted from it.
            let replaced = match self.mode {
                CorrectionMode::Parallel => 0.0,
                CorrectionMode::Convert | CorrectionMode::Serial => instant.accelerations[*place],
            };
            added[*place] = share * (answer - replaced);
        }
        added
    }

    fn addition_gradient(&self, instant: &CorrectionInstant) -> AdditionGradient {
        let mut gradient = AdditionGradient::default();
        let share = self.domain.share_at(instant);
        if share == 0.0 {
            return gradient;
        }
        // Product rule: the share depends on the motion, too.
        let by_share = self.domain.share_gradient(instant);
        for (place, output, regressor) in &self.outputs {
            let replaces = self.mode != CorrectionMode::Parallel;
            let own = OutputGradient::new(output, regressor, instant)
                .less_law_rate(replaces, instant, *place);
            own.add_to(&mut gradient, *place, (share, &by_share));
        }
        gradient
    }

    fn addition_formulas(&self) -> AdditionFormulas {
        addition_formulas(self.mode, &self.outputs, &self.domain)
    }
}
