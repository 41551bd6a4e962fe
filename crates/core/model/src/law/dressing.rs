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
    /// How the law's forces straight ahead give way where its trials do not reach.
    pub straight: Option<Straight>,
}

/// A law straight ahead, and the share of it that gives way.
#[derive(Debug, Clone, PartialEq)]
pub struct Straight {
    /// What names of states, inputs and values become straight ahead.
    pub renamed: BTreeMap<String, Expr>,
    /// The value that is the share which gives way: 0 where the trials reach.
    pub beyond: String,
}

impl Straight {
    /// A term of a sum that is multiplied by `scale`, less the share of what it is straight ahead.
    pub(crate) fn blended(&self, term: Expr, scale: &Expr) -> Expr {
        let of = |expr: &Expr| expr.renamed(&|name| self.renamed.get(name).cloned());
        let ratio = Expr::Divide(Box::new(of(scale)), Box::new(scale.clone()));
        let share = Expr::Name(self.beyond.clone()).times(ratio);
        let straight = of(&term).times(share);
        Expr::Subtract(Box::new(term), Box::new(straight))
    }

    /// Follows a name that effects have replaced by another.
    pub(crate) fn follow(&mut self, name: &str, by: &str) {
        if let Some(straight) = self.renamed.get(name).cloned() {
            self.renamed.insert(by.to_owned(), straight);
        }
    }
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
