//! Surge force of a law straight ahead at constant revolutions, and the speed at which it vanishes.

use std::collections::BTreeMap;

use sistership_model::coefficient::Axis;
use sistership_model::{Law, Model};
use sistership_simulation::equations::{EquationLowering, EquationsOfMotion, PlantError};
use sistership_simulation::tape::Tape;

/// Speeds at which a change of sign is looked for, and halvings of the interval that has it.
const SPEEDS: usize = 32;
const HALVINGS: usize = 40;

/// The surge force of a law, rudder amidships and in still air, as a function of the speed.
pub(crate) struct StraightSurge {
    tape: Tape,
    /// Inputs of the tape; `None` for the speed.
    inputs: Vec<Option<f64>>,
    /// Names of the coefficients, in the order of the terms.
    pub coefficients: Vec<String>,
    values: Vec<f64>,
}

impl StraightSurge {
    /// Lowers the surge axis of a model without its balance and effects.
    ///
    /// # Errors
    /// Returns the fault of the model or law.
    pub(crate) fn new(model: &Model, law: &Law, n_rps: f64) -> Result<Self, PlantError> {
        let equations = EquationsOfMotion::from_foundation(model, law)?;
        let names = equations.tape_input_names();
        let mut lowering = EquationLowering::new(&equations, &names);
        let coefficients: Vec<String> = equations.axis_coefficients(Axis::X).cloned().collect();
        for name in &coefficients {
            lowering.add_output(&equations.scaled_regressor(name)?)?;
        }
        // The rest is the last output, after the regressors of the coefficients.
        lowering.add_output(&equations.law().axes[&Axis::X].rest)?;
        let tape = lowering.finish();
        let defaults: BTreeMap<String, Option<f64>> = equations.law_inputs().into_iter().collect();
        let given = |name: &String| match name.as_str() {
            "u" => None,
            "n" => Some(n_rps),
            name => Some(defaults.get(name).copied().flatten().unwrap_or(0.0)),
        };
        let inputs = names.iter().map(given).collect();
        let value = |name: &String| model.coefficients.get(name).map_or(0.0, |one| one.value);
        let values = coefficients.iter().map(value).collect();
        Ok(Self { tape, inputs, coefficients, values })
    }

    /// Returns the force per unit of each coefficient, and the rest, N.
    pub(crate) fn terms(&self, u_m_s: f64) -> Vec<f64> {
        let inputs: Vec<f64> = self.inputs.iter().map(|input| input.unwrap_or(u_m_s)).collect();
        self.tape.evaluate_point(&inputs)
    }

    /// Returns the force, N.
    fn force(&self, u_m_s: f64) -> f64 {
        let terms = self.terms(u_m_s);
        let by_coefficients: f64 = terms.iter().zip(&self.values).map(|(a, b)| a * b).sum();
        by_coefficients + terms.last().copied().unwrap_or(0.0)
    }

    /// Returns the greatest speed of a range at which thrust and resistance balance, so that a
    /// faster ship slows down; `None` if there is none.
    pub(crate) fn steady_speed(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let speed = |k: usize| from + (to - from) * k as f64 / SPEEDS as f64;
        let is_driven = |u: f64| self.force(u) > 0.0;
        let last = (0..SPEEDS).rev().find(|&k| is_driven(speed(k)) && !is_driven(speed(k + 1)))?;
        let (mut low, mut high) = (speed(last), speed(last + 1));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if is_driven(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}
