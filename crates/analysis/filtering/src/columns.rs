//! Meaning of the columns: free coefficients, and parameters of candidate effects.

use std::ops::Range;
use std::sync::Arc;

use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::effect::{EffectForm, qualified_name};
use sistership_model::law::Law;

/// A property of the model that may differ slightly from its value.
#[derive(Debug, Clone, PartialEq)]
pub struct NuisanceColumn {
    /// Name, such as `Y_vvr`.
    pub name: String,
    /// Meaning of the column.
    pub kind: NuisanceKind,
}

/// Kind of a nuisance column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NuisanceKind {
    /// A coefficient of the model, on its axis.
    Own(Axis),
    /// A term that the model lacks, on its axis: its coefficient may differ from zero.
    Lacked(Axis),
    /// An entry of the virtual mass matrix, by the root of the product of its diagonal entries.
    /// Only trials without an effect of known size could not separate mass and forces: they leave
    /// the size of every force undetermined.
    Mass(Axis, Axis),
}

impl NuisanceKind {
    /// Axis of action; for a mass, the first one.
    pub fn axis(self) -> Axis {
        match self {
            Self::Own(axis) | Self::Lacked(axis) | Self::Mass(axis, _) => axis,
        }
    }
}

/// One form of an effect, with the values of its parameters at which the columns are tangents.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectCandidate {
    /// The effect's name.
    pub effect: String,
    /// The form.
    pub form: Arc<EffectForm>,
    /// Values of its parameters, in their order.
    pub at: Vec<f64>,
}

impl EffectCandidate {
    /// Creates a candidate at the absence of its effect.
    pub fn at_absence(effect: &str, form: &Arc<EffectForm>) -> Self {
        let at = form.parameters.values().map(|parameter| parameter.absent).collect();
        Self { effect: effect.to_owned(), form: Arc::clone(form), at }
    }

    /// Distance of each parameter from the absence of the effect.
    pub fn parameter_changes(&self) -> Vec<f64> {
        self.at
            .iter()
            .zip(self.form.parameters.values())
            .map(|(at, parameter)| at - parameter.absent)
            .collect()
    }

    /// Qualified names of its parameters in a law with applied effects.
    pub fn qualified_names(&self) -> impl Iterator<Item = String> + '_ {
        self.form
            .parameters
            .keys()
            .map(|name| qualified_name(&self.effect, &self.form.file.name, name))
    }

    /// Unique key, `effect/form`.
    pub fn candidate_key(&self) -> String {
        format!("{}/{}", self.effect, self.form.file.name)
    }
}

/// Meaning of the columns: coefficients first, then the parameters of each candidate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FilterColumns {
    /// Coefficients.
    pub nuisance: Vec<NuisanceColumn>,
    /// Candidates.
    pub candidates: Vec<EffectCandidate>,
}

impl FilterColumns {
    /// Number of columns.
    pub fn len(&self) -> usize {
        self.nuisance.len()
            + self.candidates.iter().map(|candidate| candidate.at.len()).sum::<usize>()
    }

    /// Returns true if there is no column.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Indices of a candidate's parameters among the columns.
    pub fn candidate_columns(&self, candidate: usize) -> Range<usize> {
        let before: usize =
            self.candidates[..candidate].iter().map(|candidate| candidate.at.len()).sum();
        let start = self.nuisance.len() + before;
        start..start + self.candidates[candidate].at.len()
    }

    /// Indices of the columns that represent a candidate: its own, or that of the coefficient which
    /// it frees.
    pub fn matching_columns(&self, candidate: &EffectCandidate) -> Vec<usize> {
        // A candidate that only frees a coefficient has no column of its own.
        let own = self
            .candidates
            .iter()
            .position(|known| known.candidate_key() == candidate.candidate_key());
        let freed =
            || self.nuisance.iter().position(|nuisance| nuisance.name == candidate.form.file.name);
        own.map_or_else(
            || freed().into_iter().collect(),
            |own| self.candidate_columns(own).collect(),
        )
    }

    /// Nuisance columns of a model: its coefficients, terms of a grammar that it lacks, and the
    /// virtual masses of its law.
    pub fn nuisance_columns(
        model: &Model,
        law: &Law,
        extra: &[(String, Axis)],
    ) -> Vec<NuisanceColumn> {
        let axis = |name: &str| law.unscaled_regressor(name).ok().map(|(axis, _)| axis);
        let own = model
            .coefficients
            .keys()
            .filter_map(|name| Some((name.clone(), NuisanceKind::Own(axis(name)?))));
        let lacked = extra.iter().map(|(name, axis)| (name.clone(), NuisanceKind::Lacked(*axis)));
        // The mass matrix is symmetric: one triangle suffices.
        let upper = law.mass.keys().filter(|(row, column)| row <= column);
        let masses = upper.map(|&(row, column)| {
            (format!("{MASS_PREFIX}{row}{column}"), NuisanceKind::Mass(row, column))
        });
        own.chain(lacked).chain(masses).map(|(name, kind)| NuisanceColumn { name, kind }).collect()
    }
}

/// Prefix of the names of virtual masses.
pub const MASS_PREFIX: &str = "mass ";

/// Name under which a law keeps the regressor of a term that its model lacks.
pub fn missing_term_name(term: &str) -> String {
    format!("lacked/{term}")
}
