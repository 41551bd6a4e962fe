//! Model with the derivatives of its rates on one tape.

use std::ops::Range;

use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::law::Law;

use crate::equations::{
    Attitude, Coefficients, EquationsOfMotion, Lowering, PlantError, constant_mobility, mobility,
};
use crate::plant::check_inputs;
use crate::tape::{Lanes, Tape};

/// Names of the moving states by their places in the state vector.
const NAMES: [&str; 8] = ["u", "v", "r", "p", "phi", "psi", "x", "y"];

/// Value on the tape and its derivatives with respect to the states, in order; absent derivatives
/// are zero.
#[derive(Debug, Clone)]
pub(super) struct Sloped {
    pub value: usize,
    pub slopes: Vec<(usize, usize)>,
}

/// Model prepared for simulation with sensitivities.
#[derive(Debug, Clone)]
pub struct SensitiveSystem {
    pub(super) tape: Tape,
    pub(super) states: &'static [usize],
    pub(super) axes: Vec<Axis>,
    pub(super) forces: Vec<Sloped>,
    pub(super) additions: Vec<Option<Sloped>>,
    pub(super) kinematics: Vec<Sloped>,
    /// Outputs of the mass matrix entries over the axes, row by row.
    mass: Vec<Option<usize>>,
    /// Accelerations per unit force on each axis, where masses do not change.
    constant: Option<Vec<f64>>,
    /// Outputs of the regressors of the coefficients, with their scale.
    pub(super) regressors: Vec<usize>,
    /// Range of the coefficients of each axis among all.
    pub(super) of_axis: Vec<Range<usize>>,
    names: Vec<String>,
    input_names: Vec<String>,
}

impl SensitiveSystem {
    /// Prepares a model with sensitivities to all of its coefficients.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give, or if masses change with the
    /// motion, or if the model has effects on instruments or lags.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        let equations = EquationsOfMotion::new(model, law)?;
        check_inputs(equations.law())?;
        equations.without_lags_or_instruments("sensitivities")?;
        Builder { equations: &equations, lowering: Lowering::new(&equations, &equations.names()) }
            .build()
    }

    /// Names of the coefficients, in the order of the columns of the sensitivities.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Places in the state vector of the rows of the sensitivities.
    pub fn states(&self) -> &'static [usize] {
        self.states
    }

    /// Names of the inputs of the law, in order.
    pub fn input_names(&self) -> &[String] {
        &self.input_names
    }

    /// Computes the accelerations per unit force on each axis, row by row over the axes, from an
    /// evaluated tape.
    pub(super) fn mobility<const L: usize>(&self, work: &[Lanes<L>], out: &mut [Lanes<L>]) {
        if let Some(constant) = &self.constant {
            out.iter_mut().zip(constant).for_each(|(out, value)| *out = [*value; L]);
            return;
        }
        let n = self.axes.len();
        for lane in 0..L {
            let entry = |output: Option<usize>| {
                output.map_or(0.0, |output| self.tape.read(output, work)[lane])
            };
            let solved = mobility(n, |i, j| entry(self.mass[i * n + j]));
            out.iter_mut().enumerate().for_each(|(k, out)| out[lane] = solved[(k / n, k % n)]);
        }
    }
}

struct Builder<'e> {
    equations: &'e EquationsOfMotion<'e>,
    lowering: Lowering<'e>,
}

/// Coefficients and the outputs of their regressors.
struct Regressors {
    names: Vec<String>,
    /// Range of the coefficients of each axis.
    of_axis: Vec<Range<usize>>,
    outputs: Vec<usize>,
}

impl Builder<'_> {
    fn build(mut self) -> Result<SensitiveSystem, PlantError> {
        let (equations, axes, states) =
            (self.equations, self.equations.axes(), self.equations.states());
        let forces = axes.iter().map(|&axis| self.force(axis)).collect::<Result<_, _>>()?;
        let additions = axes.iter().map(|&axis| self.addition(axis)).collect::<Result<_, _>>()?;
        let kinematics = states[axes.len()..]
            .iter()
            .map(|&state| self.kinematic(state))
            .collect::<Result<_, _>>()?;
        let mass = self.mass()?;
        let Regressors { names, of_axis, outputs: regressors } = self.regressors()?;
        // All outputs must be on the tape before it is finished.
        let tape = self.lowering.finish();
        let constant = constant_mobility(equations, &tape, &mass)?;
        let input_names = equations.law().inputs.keys().cloned().collect();
        let axes = axes.to_vec();
        Ok(SensitiveSystem {
            tape,
            states,
            axes,
            forces,
            additions,
            kinematics,
            mass,
            constant,
            regressors,
            of_axis,
            names,
            input_names,
        })
    }

    fn sloped(&mut self, expr: &Expr) -> Result<Sloped, PlantError> {
        let value = self.lowering.output(expr)?;
        let by = |(row, &place): (usize, &usize)| {
            Some((row, self.lowering.derivative(value, NAMES[place])?))
        };
        let slopes = self.equations.states().iter().enumerate().filter_map(by).collect();
        Ok(Sloped { value, slopes })
    }

    fn force(&mut self, axis: Axis) -> Result<Sloped, PlantError> {
        let expr = self.equations.force(axis, Coefficients::Values)?;
        self.sloped(&expr)
    }

    fn addition(&mut self, axis: Axis) -> Result<Option<Sloped>, PlantError> {
        self.equations.addition(axis).map(|sum| self.sloped(&sum)).transpose()
    }

    fn kinematic(&mut self, state: usize) -> Result<Sloped, PlantError> {
        let expr = self.equations.kinematic(state, Attitude::Upright)?;
        self.sloped(&expr)
    }

    /// Adds the mass matrix row by row; it must not change with the motion.
    fn mass(&mut self) -> Result<Vec<Option<usize>>, PlantError> {
        let (axes, states) = (self.equations.axes(), self.equations.states());
        let mut all = Vec::new();
        for (&row, &column) in
            axes.iter().flat_map(|row| axes.iter().map(move |column| (row, column)))
        {
            let output = self.lowering.mass(row, column)?;
            // The gains of a step assume masses whose derivatives are zero.
            if output.is_some_and(|o| {
                states.iter().any(|&s| self.lowering.derivative(o, NAMES[s]).is_some())
            }) {
                return Err(PlantError::MovingMass(self.equations.law().name.clone()));
            }
            all.push(output);
        }
        Ok(all)
    }

    fn regressors(&mut self) -> Result<Regressors, PlantError> {
        let mut all = Regressors { names: Vec::new(), of_axis: Vec::new(), outputs: Vec::new() };
        for &axis in self.equations.axes() {
            // The coefficients of an axis form one range of columns.
            let start = all.names.len();
            for name in self.equations.coefficients(axis) {
                all.outputs.push(self.lowering.output(&self.equations.regressor(name)?)?);
                all.names.push(name.clone());
            }
            all.of_axis.push(start..all.names.len());
        }
        Ok(all)
    }
}
