//! A form of an effect: its formulas, read and checked.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::file::{FormFile, Mirror};
use crate::coefficient::Axis;
use crate::trial::Channel;
use sistership_formula::Expr;
use sistership_formula::units::Dimension;

/// One form of an effect, read and checked. Formulas mention states, inputs, particulars, the
/// form's parameters and values by their plain names.
#[derive(Debug, Clone, PartialEq)]
pub struct Form {
    /// As the file writes it: what a model that carries the effect keeps.
    pub file: FormFile,
    /// What stands in for particulars that the ship does not state.
    pub particulars: IndexMap<String, Expr>,
    /// What is fitted.
    pub parameters: IndexMap<String, EffectParameter>,
    /// What is reported besides the parameters.
    pub reports: IndexMap<String, Report>,
    /// Intermediate values.
    pub values: IndexMap<String, Expr>,
    /// What the law sees in place of a state or an input.
    pub sees: IndexMap<String, Expr>,
    /// What is added to the accelerations.
    pub accelerates: BTreeMap<Axis, Expr>,
    /// Factors on coefficients.
    pub coefficients: IndexMap<String, Expr>,
    /// Time constants of inputs that reach the ship through a lag, s.
    pub lags: IndexMap<String, Expr>,
    /// Half widths of the bands that inputs must leave before the ship follows them.
    pub bands: IndexMap<String, Expr>,
    /// Forces and moments that are added.
    pub forces: BTreeMap<Axis, Expr>,
    /// What instruments say of the true state.
    pub measures: BTreeMap<Channel, Expr>,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectParameter {
    /// Its dimension.
    pub dimension: Dimension,
    /// Mean of its prior.
    pub prior_mean: f64,
    /// Standard deviation of its prior.
    pub prior_deviation: f64,
    /// The least and the greatest value that is believed at all.
    pub bounds: [f64; 2],
    /// The value that stands for the absence of the effect.
    pub absent: f64,
    /// Where a search begins.
    pub start: f64,
    /// Whether it is a coefficient of the form, and no size of the effect.
    pub shape: bool,
    /// What it becomes in the mirror.
    pub mirror: Mirror,
}

/// A figure that follows from the parameters. A name that ends in `_deg` is converted from radians.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The formula, in SI and radians.
    pub formula: Expr,
    /// What its value is multiplied by to be in the unit of its name.
    pub factor: f64,
}

impl Form {
    /// Every formula that acts.
    pub(crate) fn formulas(&self) -> impl Iterator<Item = &Expr> {
        let named = self
            .values
            .values()
            .chain(self.sees.values())
            .chain(self.coefficients.values())
            .chain(self.lags.values())
            .chain(self.bands.values());
        named
            .chain(self.accelerates.values())
            .chain(self.forces.values())
            .chain(self.measures.values())
    }

    /// A figure that follows from the parameters, in the unit of its name; `None` without a finite
    /// value.
    pub fn report(&self, name: &str, lookup: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        let report = self.reports.get(name)?;
        report
            .formula
            .value(lookup)
            .map(|value| value * report.factor)
            .filter(|value| value.is_finite())
    }
}
