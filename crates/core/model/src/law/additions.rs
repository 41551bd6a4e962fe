//! Additions of effects to a law.

use std::collections::BTreeMap;

use crate::coefficient::Axis;
use crate::trial::Channel;
use sistership_formula::Expr;

/// Additions of effects to a law, besides the formulas of the law that they change.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LawAdditions {
    /// Values of the effects' parameters by qualified name.
    pub parameters: BTreeMap<String, f64>,
    /// Additions to the accelerations.
    pub accelerations: Vec<(Axis, Expr)>,
    /// Factors on coefficients.
    pub coefficients: Vec<(String, Expr)>,
    /// Inputs with a lag, with its time constant, s.
    pub lags: Vec<(String, Expr)>,
    /// Inputs with a dead band, with half of its width.
    pub bands: Vec<(String, Expr)>,
    /// Readings of instruments by channel; several effects on one channel act in order.
    pub measures: Vec<(Channel, Expr)>,
    /// Replacement of the law's forces straight ahead outside the range covered by trials.
    pub straight: Option<StraightAhead>,
}

/// Forces of a law straight ahead, and the share of them that is replaced.
#[derive(Debug, Clone, PartialEq)]
pub struct StraightAhead {
    /// Replacements of names of states, inputs and values straight ahead.
    pub renamed: BTreeMap<String, Expr>,
    /// Name of the value that is the replaced share: 0 within the range covered by trials.
    pub beyond: String,
}

impl StraightAhead {
    /// Returns a term of a sum that is multiplied by `scale`, less the replaced share of its value
    /// straight ahead.
    pub(crate) fn subtract_share(&self, term: Expr, scale: &Expr) -> Expr {
        let of = |expr: &Expr| expr.replace_names(&|name| self.renamed.get(name).cloned());
        // The scale straight ahead may differ from `scale`, by which the sum is multiplied later.
        let ratio = Expr::Divide(Box::new(of(scale)), Box::new(scale.clone()));
        let share = Expr::Name(self.beyond.clone()).times(ratio);
        let straight = of(&term).times(share);
        Expr::Subtract(Box::new(term), Box::new(straight))
    }

    /// Adds the name by which effects have replaced another one.
    pub(crate) fn follow_rename(&mut self, name: &str, by: &str) {
        if let Some(straight) = self.renamed.get(name).cloned() {
            self.renamed.insert(by.to_owned(), straight);
        }
    }
}

impl LawAdditions {
    /// Formulas of all additions.
    pub(crate) fn all_formulas(&self) -> impl Iterator<Item = &Expr> {
        let named =
            self.coefficients.iter().chain(&self.lags).chain(&self.bands).map(|(_, expr)| expr);
        let of_axes = self.accelerations.iter().map(|(_, expr)| expr);
        named.chain(of_axes).chain(self.measures.iter().map(|(_, expr)| expr))
    }
}
