//! What effects add to a law.

use std::collections::BTreeMap;

use crate::coefficient::Axis;
use crate::trial::Channel;
use sistership_formula::Expr;

/// What effects add to a law, beside the formulas of its own that they change.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Dressing {
    /// Values of the effects' parameters by qualified name.
    pub parameters: BTreeMap<String, f64>,
    /// Added to the accelerations.
    pub accelerations: Vec<(Axis, Expr)>,
    /// Factors on coefficients.
    pub coefficients: Vec<(String, Expr)>,
    /// Inputs behind a lag, with its time constant, s.
    pub lags: Vec<(String, Expr)>,
    /// Inputs with a dead band, with half of its width.
    pub bands: Vec<(String, Expr)>,
    /// What instruments say, by channel; several effects on one channel follow each other.
    pub measures: Vec<(Channel, Expr)>,
}

impl Dressing {
    /// Its formulas.
    pub(crate) fn formulas(&self) -> impl Iterator<Item = &Expr> {
        let named =
            self.coefficients.iter().chain(&self.lags).chain(&self.bands).map(|(_, expr)| expr);
        let of_axes = self.accelerations.iter().map(|(_, expr)| expr);
        named.chain(of_axes).chain(self.measures.iter().map(|(_, expr)| expr))
    }
}
