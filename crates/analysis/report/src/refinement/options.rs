//! Tuning options of the widening ranges.

use serde::Serialize;
use sistership_identification::refine::StepOption;

use super::input::RefinementInput;

/// All tuning options with the names of their columns.
#[derive(Debug, Serialize)]
pub(crate) struct StepOptions<'a> {
    /// Acceleration of each lambda and alpha, in their order.
    pub accelerations: Vec<String>,
    pub steps: &'a [StepOption],
}

impl<'a> StepOptions<'a> {
    pub fn from_input(input: &RefinementInput<'a>) -> Self {
        let steps = input.refinement.options.as_slice();
        let width = steps.iter().map(|step| step.lambda.len()).max().unwrap_or(0);
        let axes: Vec<String> =
            input.law.axes.keys().map(|axis| format!("d{}/dt", axis.velocity_name())).collect();
        // Names by number, if the regressions are not one for each axis.
        let numbered = || (1..=width).map(|number| format!("regression {number}")).collect();
        // A law may be regressed in another number of equations than it has axes.
        Self { accelerations: if axes.len() == width { axes } else { numbered() }, steps }
    }
}
