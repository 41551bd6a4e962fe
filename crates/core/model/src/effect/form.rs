//! Form of an effect, with parsed and checked formulas.

use std::collections::{BTreeMap, BTreeSet};

use indexmap::IndexMap;

use super::file::{FormFile, Mirror};
use crate::coefficient::Axis;
use crate::particulars::{self, Particulars};
use crate::trial::Channel;
use sistership_formula::Expr;
use sistership_formula::units::Dimension;

/// One form of an effect, read and checked. Formulas use the plain names of states, inputs,
/// particulars, and of the form's parameters and values.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectForm {
    /// The form as its file writes it, which a model with the effect keeps.
    pub file: FormFile,
    /// Formulas that replace particulars which the ship does not state.
    pub particulars: IndexMap<String, Expr>,
    /// Parameters that are fitted.
    pub parameters: IndexMap<String, EffectParameter>,
    /// Figures that are reported besides the parameters.
    pub reports: IndexMap<String, ReportedFigure>,
    /// Intermediate values.
    pub values: IndexMap<String, Expr>,
    /// Formulas that replace a state or an input in the law.
    pub sees: IndexMap<String, Expr>,
    /// Additions to the accelerations.
    pub accelerates: BTreeMap<Axis, Expr>,
    /// Factors on coefficients.
    pub coefficients: IndexMap<String, Expr>,
    /// Time constants of inputs with a lag, s.
    pub lags: IndexMap<String, Expr>,
    /// Half widths of the dead bands of inputs.
    pub bands: IndexMap<String, Expr>,
    /// Added forces and moments.
    pub forces: BTreeMap<Axis, Expr>,
    /// Readings of instruments as formulas of the true state.
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
    /// Least and greatest value that is plausible.
    pub bounds: [f64; 2],
    /// The value that represents the absence of the effect.
    pub absent: f64,
    /// Initial value of a search.
    pub start: f64,
    /// True for a coefficient of the form, which is not a size of the effect.
    pub shape: bool,
    /// Its transformation in the mirror.
    pub mirror: Mirror,
}

/// Figure that follows from the parameters. A name that ends in `_deg` is converted from radians.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportedFigure {
    /// Formula, in SI and radians.
    pub formula: Expr,
    /// Factor that converts the value to the unit of the figure's name.
    pub factor: f64,
}

impl EffectForm {
    /// First particular that the formulas use, the ship does not state and the form does not replace.
    pub fn missing_particular(&self, stated: &Particulars) -> Option<&'static str> {
        let mentioned: BTreeSet<&str> =
            self.acting_formulas().flat_map(Expr::mentioned_names).collect();
        let own = |name: &str| {
            self.parameters.contains_key(name)
                || self.values.contains_key(name)
                || self.particulars.contains_key(name)
        };
        particulars::particular_names().find(|name| {
            mentioned.contains(name)
                && !own(name)
                && particulars::particular_value(stated, name).is_none()
        })
    }

    /// Every formula that acts on the law or the instruments.
    pub(crate) fn acting_formulas(&self) -> impl Iterator<Item = &Expr> {
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

    /// Value of a reported figure, in the unit of its name; `None` without a finite value.
    pub fn report_value(&self, name: &str, lookup: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        let report = self.reports.get(name)?;
        report
            .formula
            .value(lookup)
            .map(|value| value * report.factor)
            .filter(|value| value.is_finite())
    }
}
