//! What the columns stand for: coefficients that may move, and parameters of effects that may be missing.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::effect::{Form, qualified};
use sistership_model::law::Law;

/// A coefficient that may move, or a term that the model lacks and whose coefficient may differ from zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Nuisance {
    /// Its name, such as `Y_vvr`.
    pub name: String,
    /// The axis it acts on.
    pub axis: Axis,
    /// Whether the model has it.
    pub own: bool,
}

/// One form of an effect, with values of its parameters at which the columns are tangents.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The effect's name.
    pub effect: String,
    /// The form.
    pub form: Arc<Form>,
    /// Values of its parameters, in their order.
    pub at: Vec<f64>,
}

impl Candidate {
    /// A form at the absence of its effect.
    pub fn absent(effect: &str, form: &Arc<Form>) -> Self {
        let at = form.parameters.values().map(|parameter| parameter.absent).collect();
        Self { effect: effect.to_owned(), form: Arc::clone(form), at }
    }

    /// The names of its parameters in a dressed law.
    pub fn qualified(&self) -> impl Iterator<Item = String> + '_ {
        self.form.parameters.keys().map(|name| qualified(&self.effect, &self.form.file.name, name))
    }

    /// `effect/form`, which is unique.
    pub fn key(&self) -> String {
        format!("{}/{}", self.effect, self.form.file.name)
    }
}

/// What the columns stand for: coefficients first, then the parameters of each candidate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Columns {
    /// Coefficients.
    pub nuisance: Vec<Nuisance>,
    /// Candidates.
    pub candidates: Vec<Candidate>,
}

impl Columns {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.nuisance.len() + self.candidates.iter().map(|candidate| candidate.at.len()).sum::<usize>()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The places of a candidate's parameters.
    pub fn places(&self, candidate: usize) -> Range<usize> {
        let before: usize = self.candidates[..candidate].iter().map(|candidate| candidate.at.len()).sum();
        let start = self.nuisance.len() + before;
        start..start + self.candidates[candidate].at.len()
    }

    /// The coefficients that a model has, and terms of a grammar that it lacks.
    pub fn nuisance(model: &Model, law: &Law, extra: &[(String, Axis)]) -> Vec<Nuisance> {
        let axis = |name: &str| law.term(name).ok().map(|(axis, _)| axis);
        let own =
            model.coefficients.keys().filter_map(|name| Some(Nuisance { name: name.clone(), axis: axis(name)?, own: true }));
        let lacked = extra.iter().map(|(name, axis)| Nuisance { name: name.clone(), axis: *axis, own: false });
        own.chain(lacked).collect()
    }

    /// The places of coefficients by name.
    pub fn by_name(&self) -> BTreeMap<&str, usize> {
        self.nuisance.iter().enumerate().map(|(place, nuisance)| (nuisance.name.as_str(), place)).collect()
    }
}
