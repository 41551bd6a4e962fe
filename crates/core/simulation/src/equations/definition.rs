//! The equations of motion: `M (nu' - a) = F`, where `nu` are the velocities, `F` the forces of the
//! law and `a` the accelerations that effects add, and the kinematics.

use std::borrow::Cow;
use std::collections::BTreeSet;

use sistership_formula::{Expr, parse};
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::law::{Law, STATES};
use sistership_model::particulars;

use super::plant_error::PlantError;
use crate::state::at;
use crate::tape::NameBinding;

/// Places in the state vector of the moving states: velocities first, in the order of the axes.
const STATES_3DOF: [usize; 6] = [at::U, at::V, at::R, at::PSI, at::X, at::Y];
const STATES_4DOF: [usize; 8] = [at::U, at::V, at::R, at::P, at::PHI, at::PSI, at::X, at::Y];

/// Axes in the order of the velocities among those states.
const ALL_AXES: [Axis; 4] = [Axis::X, Axis::Y, Axis::N, Axis::K];

/// Representation of the coefficients in a force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CoefficientBinding {
    /// The values of the model that are not zero.
    Values,
    /// The name of each coefficient of the model, as an input of the tape.
    Names,
    /// The names of coefficients, parameters and particulars, each as an input of the tape.
    AllNames,
}

/// Attitude of the ship's axes in kinematics that the law does not define.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxesAttitude {
    /// Velocities are horizontal.
    Upright,
    /// Velocities are measured along axes that heel with the ship.
    Heeled,
}

/// A law with the coefficients, parameters, particulars and effects of a model.
#[derive(Debug, Clone)]
pub struct EquationsOfMotion<'a> {
    model: &'a Model,
    law: Cow<'a, Law>,
}

impl<'a> EquationsOfMotion<'a> {
    /// Sets up the equations of a law with the effects that a model carries.
    ///
    /// # Errors
    /// Returns an error that names the effect that cannot be used. Refuses a model with a learned
    /// correction, which is not a formula: only [`Ship`](crate::Ship) simulates both.
    pub fn new(model: &'a Model, law: &'a Law) -> Result<Self, PlantError> {
        if model.branch.is_some() {
            return Err(PlantError::Branch(model.name.clone()));
        }
        Self::from_foundation(model, law)
    }

    /// Sets up the equations as [`EquationsOfMotion::new`] does, without the learned correction.
    ///
    /// # Errors
    /// Returns an error that names the effect that cannot be used.
    pub fn from_foundation(model: &'a Model, law: &'a Law) -> Result<Self, PlantError> {
        if model.effects.is_empty() && model.propulsion.is_none() {
            return Ok(Self::from_law(model, Cow::Borrowed(law)));
        }
        let dressed = law
            .with_effects(model)
            .map_err(|(field, message)| PlantError::Effect { field, message })?;
        Ok(Self::from_law(model, Cow::Owned(dressed)))
    }

    /// Sets up the equations of a law as it is: effects are in it already, or are left out.
    pub fn from_law(model: &'a Model, law: Cow<'a, Law>) -> Self {
        Self { model, law }
    }

    /// The model.
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// The law with the effects.
    pub fn law(&self) -> &Law {
        &self.law
    }

    /// Input names of a tape of forces: the states that formulas can use, then the inputs of the
    /// law.
    pub fn tape_input_names(&self) -> Vec<String> {
        // Evaluators rely on this order: states first, then the inputs of the law.
        STATES
            .iter()
            .map(|&(name, _)| name.to_owned())
            .chain(self.law.inputs.keys().cloned())
            .collect()
    }

    /// Inputs of the law with their defaults.
    pub fn law_inputs(&self) -> Vec<(String, Option<f64>)> {
        self.law.inputs.iter().map(|(name, input)| (name.clone(), input.default)).collect()
    }

    /// Axes in the order of the velocities: X, Y, N, and K for a 4-DOF law.
    pub fn axes(&self) -> &'static [Axis] {
        if self.law.has_roll() { &ALL_AXES } else { &ALL_AXES[..3] }
    }

    /// Places in the state vector of the moving states: velocities in the order of the axes, then
    /// attitude and position.
    pub fn state_places(&self) -> &'static [usize] {
        if self.law.has_roll() { &STATES_4DOF } else { &STATES_3DOF }
    }

    /// Returns the formula or value of a name of the law; `None` for an unknown name.
    pub fn name_binding(&self, name: &str) -> Option<NameBinding> {
        if let Some(expr) = self.law.values.get(name) {
            return Some(NameBinding::Formula(expr.clone()));
        }
        // Parameters of effects take precedence over those of the model, and both over particulars.
        let of_effect = self.law.dressing.parameters.get(name).copied();
        let parameter =
            of_effect.or_else(|| self.model.parameters.get(name).map(|quantity| quantity.value));
        parameter
            .or_else(|| particulars::particular_value(&self.model.particulars, name))
            .map(NameBinding::Constant)
    }

    /// Names of the parameters of effects and of the model, and of its particulars, that formulas
    /// can read as numbers.
    pub fn constant_names(&self) -> Vec<String> {
        let parameters = self.law.dressing.parameters.keys().chain(self.model.parameters.keys());
        let particulars = particulars::particular_names().map(str::to_owned);
        let names: BTreeSet<String> = parameters.cloned().chain(particulars).collect();
        let is_constant = |name: &String| {
            let known = self.law.inputs.contains_key(name);
            !known && matches!(self.name_binding(name), Some(NameBinding::Constant(_)))
        };
        names.into_iter().filter(is_constant).collect()
    }

    /// Names of the coefficients that the model has on an axis.
    pub fn axis_coefficients(&self, axis: Axis) -> impl Iterator<Item = &'a String> + use<'a> {
        let prefix = format!("{axis}_");
        self.model.coefficients.keys().filter(move |name| name.starts_with(&prefix))
    }

    /// Returns the regressor of a coefficient without the scale of its axis.
    ///
    /// # Errors
    /// Returns an error if the law has no such coefficient.
    pub fn unscaled_regressor(&self, name: &str) -> Result<Expr, PlantError> {
        Ok(self.law.unscaled_regressor(name)?.1)
    }

    /// Returns the regressor of a coefficient with the scale of its axis, N (N m) per unit.
    ///
    /// # Errors
    /// Returns an error if the law has no such coefficient.
    pub fn scaled_regressor(&self, name: &str) -> Result<Expr, PlantError> {
        Ok(self.law.scaled_regressor(name)?.1)
    }

    /// Returns the whole right-hand side of an axis, N (N m): coefficients times regressors, and
    /// the rest.
    ///
    /// # Errors
    /// Returns an error that names a coefficient that the law does not have.
    pub fn axis_force(
        &self,
        axis: Axis,
        coefficients: CoefficientBinding,
    ) -> Result<Expr, PlantError> {
        let axis_law = &self.law.axes[&axis];
        let mut sum = Expr::Number(0.0);
        for (name, quantity) in &self.model.coefficients {
            let factor = match coefficients {
                // Zero coefficients are left out, which keeps the tape short.
                CoefficientBinding::Values if quantity.value == 0.0 => continue,
                CoefficientBinding::Values => Expr::Number(quantity.value),
                CoefficientBinding::Names | CoefficientBinding::AllNames => {
                    Expr::Name(name.clone())
                }
            };
            let (acts_on, term) = self.law.unscaled_regressor(name)?;
            if acts_on == axis {
                sum = Expr::Add(Box::new(sum), Box::new(term.times(factor)));
            }
        }
        // `scale * sum + rest`
        Ok(Expr::Add(Box::new(axis_law.scale.clone().times(sum)), Box::new(axis_law.rest.clone())))
    }

    /// Acceleration that effects add on an axis, m/s2 (rad/s2); `None` if no effect adds any.
    pub fn added_acceleration(&self, axis: Axis) -> Option<Expr> {
        let added = self
            .law
            .dressing
            .accelerations
            .iter()
            .filter(|(of, _)| *of == axis)
            .map(|(_, expr)| expr.clone());
        added.reduce(|sum, expr| Expr::Add(Box::new(sum), Box::new(expr)))
    }

    /// Returns the rate of a state other than a velocity: that of the law, or by default that of
    /// motion in the horizontal plane, in m/s or rad/s.
    ///
    /// # Errors
    /// Returns an error if a built-in formula cannot be parsed; no law can cause this.
    pub fn kinematic_rate(&self, state: usize, attitude: AxesAttitude) -> Result<Expr, PlantError> {
        let (name, upright, heeled) = match state {
            at::PHI => ("phi", "p", "p"),
            at::PSI => ("psi", "r", "r*cos(phi)"),
            at::X => ("x", "u*cos(psi) - v*sin(psi)", "u*cos(psi) - v*sin(psi)*cos(phi)"),
            // The remaining state is y.
            _ => ("y", "u*sin(psi) + v*cos(psi)", "u*sin(psi) + v*cos(psi)*cos(phi)"),
        };
        match self.law.kinematics.get(name) {
            Some(expr) => Ok(expr.clone()),
            None => Ok(parse(if attitude == AxesAttitude::Upright { upright } else { heeled })?),
        }
    }

    /// Refuses a model with a lag, a dead band or an effect on instruments, which some views cannot
    /// represent.
    ///
    /// Returns an error that names the model and the view.
    /// Names the model and the view.
    pub fn reject_lags_and_instruments(&self, view: &'static str) -> Result<(), PlantError> {
        let dressing = &self.law.dressing;
        if dressing.lags.is_empty() && dressing.bands.is_empty() && dressing.measures.is_empty() {
            return Ok(());
        }
        Err(PlantError::Unsupported { model: self.model.name.clone(), view })
    }
}
