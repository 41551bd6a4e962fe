//! Changes of the coefficients.

use serde::Serialize;
use sistership_identification::refine::CoefficientChange;

use super::input::RefinementInput;
use super::provenance;

/// All coefficients by axis, and the groups that the trials cannot distinguish.
#[derive(Debug, Serialize)]
pub(crate) struct CoefficientReport<'a> {
    pub axes: Vec<AxisChanges<'a>>,
    pub collinear_groups: &'a [Vec<String>],
    pub condition_number: f64,
}

/// Coefficients of one axis.
#[derive(Debug, Serialize)]
pub(crate) struct AxisChanges<'a> {
    pub axis: &'a str,
    pub coefficients: Vec<CoefficientEntry<'a>>,
}

/// One coefficient with its change.
#[derive(Debug, Serialize)]
pub(crate) struct CoefficientEntry<'a> {
    #[serde(flatten)]
    pub change: &'a CoefficientChange,
    /// Change relative to the size of the source's value, in per cent; `None` if that is zero.
    pub moved_percent: Option<f64>,
    /// Number of its collinear group, from 1.
    pub collinear_group: Option<usize>,
    /// True if the source's value is an estimate.
    pub source_estimated: bool,
    /// False if the trials do not determine it, so that it is the prior's.
    pub determined: bool,
}

impl<'a> CoefficientReport<'a> {
    /// Collects the coefficients of a refinement.
    pub fn from_input(input: &RefinementInput<'a>) -> Self {
        let refinement = input.refinement;
        let mut axes: Vec<AxisChanges<'a>> = Vec::new();
        for axis in ["X", "Y", "K", "N", PARAMETERS] {
            let own = refinement.coefficients.iter().filter(|change| axis_of(&change.name) == axis);
            let coefficients: Vec<CoefficientEntry<'a>> =
                own.map(|change| CoefficientEntry::from_change(input, change)).collect();
            if !coefficients.is_empty() {
                axes.push(AxisChanges { axis, coefficients });
            }
        }
        Self {
            axes,
            collinear_groups: &refinement.collinear_groups,
            condition_number: refinement.condition_number,
        }
    }

    /// Returns all coefficients.
    pub fn all_entries(&self) -> impl Iterator<Item = &CoefficientEntry<'a>> {
        self.axes.iter().flat_map(|axis| &axis.coefficients)
    }

    /// Power of ten of the displayed values: -5, that of the prime system, if all are without unit
    /// and most are small; otherwise 0.
    pub fn display_exponent(&self) -> i32 {
        let mut sizes: Vec<f64> =
            self.all_entries().map(|c| c.change.source.abs()).filter(|size| *size > 0.0).collect();
        sizes.sort_by(f64::total_cmp);
        // Parameters are of the order of one whatever the coefficients are.
        let bare = self.all_entries().all(|c| c.change.unit == "1")
            && !self.axes.iter().any(|axis| axis.axis == PARAMETERS);
        // Judged by the median, as single coefficients may be large.
        let small = sizes.get(sizes.len() / 2).is_some_and(|median| *median < 0.02);
        if bare && small { -5 } else { 0 }
    }
}

impl<'a> CoefficientEntry<'a> {
    fn from_change(input: &RefinementInput<'_>, change: &'a CoefficientChange) -> Self {
        let groups = &input.refinement.collinear_groups;
        let in_group = |group: &Vec<String>| {
            // A name may stand for the same regressor of several axes, separated by a slash.
            group.iter().any(|names| names.split('/').any(|name| name == change.name))
        };
        let quantity = input.refinement.transferred.coefficients.get(&change.name);
        Self {
            change,
            determined: change.is_determined(),
            moved_percent: (change.source != 0.0)
                .then(|| 100.0 * (change.refined - change.source) / change.source.abs()),
            collinear_group: groups.iter().position(in_group).map(|index| index + 1),
            source_estimated: quantity
                .is_some_and(|quantity| provenance::is_estimated(&quantity.source)),
        }
    }
}

/// Heading of the nonlinear parameters of the law.
const PARAMETERS: &str = "parameters";

fn axis_of(name: &str) -> &str {
    let prefix = name.split_once('_').map_or("", |(axis, _)| axis);
    if ["X", "Y", "K", "N"].contains(&prefix) { prefix } else { PARAMETERS }
}
