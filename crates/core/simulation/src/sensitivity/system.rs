//! Model with the derivatives of its rates on one tape.

use std::ops::Range;

use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::law::Law;

use crate::equations::{
    AxesAttitude, CoefficientBinding, EquationLowering, EquationsOfMotion, PlantError,
    constant_mobility, solve_mobility,
};
use crate::plant::check_inputs;
use crate::tape::{LaneValues, Tape};

/// Names of the moving states by their places in the state vector.
const STATE_NAMES: [&str; 8] = ["u", "v", "r", "p", "phi", "psi", "x", "y"];

/// Value on the tape and its derivatives with respect to the states, in order; absent derivatives
/// are zero.
#[derive(Debug, Clone)]
pub(super) struct WithGradient {
    pub value: usize,
    pub slopes: Vec<(usize, usize)>,
}

/// Model prepared for simulation with sensitivities.
#[derive(Debug, Clone)]
pub struct SensitiveSystem {
    pub(super) tape: Tape,
    pub(super) states: &'static [usize],
    pub(super) axes: Vec<Axis>,
    pub(super) forces: Vec<WithGradient>,
    pub(super) additions: Vec<Option<WithGradient>>,
    pub(super) kinematics: Vec<WithGradient>,
    /// Outputs of the mass matrix entries over the axes, row by row.
    mass: Vec<Option<usize>>,
    /// Accelerations per unit force on each axis, where masses do not change.
    constant: Option<Vec<f64>>,
    /// Outputs of the forces per unit of each column: regressors of the coefficients with their
    /// scale, then derivatives by the parameters, which act on several axes.
    pub(super) regressors: Vec<usize>,
    /// Ranges of columns with the axis on which they act.
    pub(super) of_axis: Vec<(usize, Range<usize>)>,
    /// Names of the coefficients, then of the parameters.
    names: Vec<String>,
    /// Columns of each parameter, one for each axis on which it acts.
    parameter_columns: Vec<Vec<usize>>,
    /// Values of the parameters, inputs of the tape after those of the law.
    pub(super) parameter_values: Vec<f64>,
    input_names: Vec<String>,
}

impl SensitiveSystem {
    /// Prepares a model with sensitivities to all of its coefficients.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give, or if masses change with the
    /// motion, or if the model has effects on instruments or lags.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        Self::with_parameters(model, law, &[])
    }

    /// Prepares a model with sensitivities to all of its coefficients and to some parameters of its
    /// law, on which masses must not depend.
    ///
    /// # Errors
    /// As [`SensitiveSystem::new`], and if the model does not give a parameter.
    pub fn with_parameters(
        model: &Model,
        law: &Law,
        parameters: &[String],
    ) -> Result<Self, PlantError> {
        let equations = EquationsOfMotion::new(model, law)?;
        check_inputs(equations.law())?;
        equations.reject_lags_and_instruments("sensitivities")?;
        // A parameter that is an input of the tape has derivatives.
        let inputs = [equations.tape_input_names(), parameters.to_vec()].concat();
        SensitivityBuilder {
            equations: &equations,
            lowering: EquationLowering::new(&equations, &inputs),
            parameters,
        }
        .build_system()
    }

    /// Names of the coefficients, then of the parameters.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Writes the sensitivities of a state to each of [`SensitiveSystem::names`] into `out`, from
    /// the columns that a run holds of it.
    pub fn gather_sensitivities(&self, columns: &[f64], out: &mut [f64]) {
        let coefficients = self.names.len() - self.parameter_columns.len();
        out[..coefficients].copy_from_slice(&columns[..coefficients]);
        // A parameter acts on several axes, whose effects on the state add up.
        for (out, own) in out[coefficients..].iter_mut().zip(&self.parameter_columns) {
            *out = own.iter().map(|&column| columns[column]).sum();
        }
    }

    /// Places in the state vector of the rows of the sensitivities.
    pub fn state_places(&self) -> &'static [usize] {
        self.states
    }

    /// Names of the inputs of the law, in order.
    pub fn input_names(&self) -> &[String] {
        &self.input_names
    }

    /// Computes the accelerations per unit force on each axis, row by row over the axes, from an
    /// evaluated tape.
    pub(super) fn evaluate_mobility<const L: usize>(
        &self,
        work: &[LaneValues<L>],
        out: &mut [LaneValues<L>],
    ) {
        if let Some(constant) = &self.constant {
            out.iter_mut().zip(constant).for_each(|(out, value)| *out = [*value; L]);
            return;
        }
        let n = self.axes.len();
        for lane in 0..L {
            let entry = |output: Option<usize>| {
                output.map_or(0.0, |output| self.tape.output_lanes(output, work)[lane])
            };
            let solved = solve_mobility(n, |i, j| entry(self.mass[i * n + j]));
            out.iter_mut().enumerate().for_each(|(k, out)| out[lane] = solved[(k / n, k % n)]);
        }
    }
}

struct SensitivityBuilder<'e> {
    equations: &'e EquationsOfMotion<'e>,
    lowering: EquationLowering<'e>,
    parameters: &'e [String],
}

/// Outputs of the forces per unit of each column.
#[derive(Default)]
struct RegressorOutputs {
    /// Names of the coefficients.
    names: Vec<String>,
    /// Ranges of columns with the axis on which they act.
    of_axis: Vec<(usize, Range<usize>)>,
    outputs: Vec<usize>,
    /// Columns of each parameter.
    parameter_columns: Vec<Vec<usize>>,
}

impl SensitivityBuilder<'_> {
    fn build_system(mut self) -> Result<SensitiveSystem, PlantError> {
        let (equations, axes, states) =
            (self.equations, self.equations.axes(), self.equations.state_places());
        let forces: Vec<WithGradient> =
            axes.iter().map(|&axis| self.add_axis_force(axis)).collect::<Result<_, _>>()?;
        let additions =
            axes.iter().map(|&axis| self.add_axis_acceleration(axis)).collect::<Result<_, _>>()?;
        let kinematics = states[axes.len()..]
            .iter()
            .map(|&state| self.add_kinematic_rate(state))
            .collect::<Result<_, _>>()?;
        let mass = self.add_constant_mass()?;
        let mut columns = self.add_regressors()?;
        self.add_parameter_derivatives(&forces, &mut columns);
        let RegressorOutputs { mut names, of_axis, outputs: regressors, parameter_columns } =
            columns;
        names.extend_from_slice(self.parameters);
        let parameter_values = self.parameter_values()?;
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
            parameter_columns,
            parameter_values,
            input_names,
        })
    }

    fn add_with_gradient(&mut self, expr: &Expr) -> Result<WithGradient, PlantError> {
        let value = self.lowering.add_output(expr)?;
        let by = |(row, &place): (usize, &usize)| {
            Some((row, self.lowering.add_derivative(value, STATE_NAMES[place])?))
        };
        let slopes = self.equations.state_places().iter().enumerate().filter_map(by).collect();
        Ok(WithGradient { value, slopes })
    }

    fn add_axis_force(&mut self, axis: Axis) -> Result<WithGradient, PlantError> {
        let expr = self.equations.axis_force(axis, CoefficientBinding::Values)?;
        self.add_with_gradient(&expr)
    }

    fn add_axis_acceleration(&mut self, axis: Axis) -> Result<Option<WithGradient>, PlantError> {
        self.equations.added_acceleration(axis).map(|sum| self.add_with_gradient(&sum)).transpose()
    }

    fn add_kinematic_rate(&mut self, state: usize) -> Result<WithGradient, PlantError> {
        let expr = self.equations.kinematic_rate(state, AxesAttitude::Upright)?;
        self.add_with_gradient(&expr)
    }

    /// Adds the mass matrix row by row; it must not change with the motion.
    fn add_constant_mass(&mut self) -> Result<Vec<Option<usize>>, PlantError> {
        let (axes, states) = (self.equations.axes(), self.equations.state_places());
        let mut all = Vec::new();
        for (&row, &column) in
            axes.iter().flat_map(|row| axes.iter().map(move |column| (row, column)))
        {
            let output = self.lowering.add_mass_entry(row, column)?;
            // The gains of a step assume masses whose derivatives are zero.
            let constant = states.iter().map(|&state| STATE_NAMES[state]);
            let mut constant = constant.chain(self.parameters.iter().map(String::as_str));
            if output.is_some_and(|output| {
                constant.any(|name| self.lowering.add_derivative(output, name).is_some())
            }) {
                return Err(PlantError::MovingMass(self.equations.law().name.clone()));
            }
            all.push(output);
        }
        Ok(all)
    }

    fn add_regressors(&mut self) -> Result<RegressorOutputs, PlantError> {
        let mut all = RegressorOutputs::default();
        for (place, &axis) in self.equations.axes().iter().enumerate() {
            // The coefficients of an axis form one range of columns.
            let start = all.names.len();
            for name in self.equations.axis_coefficients(axis) {
                all.outputs
                    .push(self.lowering.add_output(&self.equations.scaled_regressor(name)?)?);
                all.names.push(name.clone());
            }
            all.of_axis.push((place, start..all.names.len()));
        }
        Ok(all)
    }

    /// Adds the derivatives of the forces by each parameter, axis by axis; one that is zero has no
    /// column.
    fn add_parameter_derivatives(&mut self, forces: &[WithGradient], all: &mut RegressorOutputs) {
        all.parameter_columns = vec![Vec::new(); self.parameters.len()];
        for (axis, force) in forces.iter().enumerate() {
            let start = all.outputs.len();
            for (own, name) in all.parameter_columns.iter_mut().zip(self.parameters) {
                if let Some(output) = self.lowering.add_derivative(force.value, name) {
                    own.push(all.outputs.len());
                    all.outputs.push(output);
                }
            }
            all.of_axis.push((axis, start..all.outputs.len()));
        }
    }

    /// Values of the parameters in the model.
    fn parameter_values(&self) -> Result<Vec<f64>, PlantError> {
        let model = self.equations.model();
        let value = |name: &String| {
            let missing = || PlantError::Missing {
                law: self.equations.law().name.clone(),
                name: name.clone(),
                model: model.name.clone(),
            };
            model.parameters.get(name).map(|quantity| quantity.value).ok_or_else(missing)
        };
        self.parameters.iter().map(value).collect()
    }
}
