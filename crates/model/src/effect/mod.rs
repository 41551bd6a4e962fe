//! An effect: what changes a law from outside, as data.

mod as_terms;
mod dress;
mod file;
mod form;
mod grammar;
mod names;
mod probe;
mod read;
mod scope;
mod symmetry;
mod term;

use std::collections::BTreeMap;
use std::sync::Arc;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use as_terms::AsTerms;
pub use dress::{Dressing, TIME, input_channel, qualified};
pub use file::{ActsOn, EffectFile, EffectParameterFile, FormFile, GrammarFile, Mirror, PriorFile};
pub use grammar::Grammar;

use crate::FileError;
use crate::coefficient::Axis;
use crate::formula::Expr;
use crate::quantity::Quantity;
use crate::source::Source;
use crate::trial::Channel;
use crate::units::Dimension;

/// An effect, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Its name in the zoo.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// Where it was published.
    pub sources: BTreeMap<String, Source>,
    /// A remark.
    pub note: Option<String>,
    /// The forms in which it may appear; none where terms are searched for.
    pub forms: Vec<Arc<Form>>,
    /// Terms that are searched for.
    pub grammar: Option<Grammar>,
}

/// One form of an effect, read and checked. Formulas mention states, inputs, particulars, the form's parameters and
/// values by their plain names.
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

impl Effect {
    /// Reads and checks an effect; `file` is the name that errors give it.
    ///
    /// # Errors
    /// Names file, line and field of the first thing that is wrong: syntax, an unknown name, a unit, a symmetry.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        read::read(file, text)
    }
}

/// An effect that a model carries: its definition and the values of its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AppliedEffect {
    /// The effect's name.
    pub name: String,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// Values of its parameters.
    pub parameters: BTreeMap<String, Quantity>,
    /// The form as its file defines it, so that the model means the same wherever it is read.
    pub form: FormFile,
}
