//! The steps of the widening ranges.

use serde::Serialize;
use sistership_identification::refine::StepOption;

use super::input::RefinementInput;

/// Every option with the names of its columns.
#[derive(Debug, Serialize)]
pub(crate) struct StepOptions<'a> {
    /// What each lambda and alpha belongs to, in their order.
    pub accelerations: Vec<String>,
    pub steps: &'a [StepOption],
}

impl<'a> StepOptions<'a> {
    pub fn of(input: &RefinementInput<'a>) -> Self {
        let steps = input.refinement.options.as_slice();
        let width = steps.iter().map(|step| step.lambda.len()).max().unwrap_or(0);
        let axes: Vec<String> =
            input.law.axes.keys().map(|axis| format!("d{}/dt", axis.velocity())).collect();
        let numbered = || (1..=width).map(|number| format!("regression {number}")).collect();
        Self { accelerations: if axes.len() == width { axes } else { numbered() }, steps }
    }
}
