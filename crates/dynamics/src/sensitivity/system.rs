//! A model with the slopes of its rates on one tape.

use std::ops::Range;

use nalgebra::Matrix4;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::formula::{Expr, parse};
use sistership_model::law::{Law, STATES};

use crate::plant::{MAX_INPUTS, PlantError, binding, dressed, force};
use crate::state::at;
use crate::tape::{Lanes, Tape, TapeBuilder};

/// Places in the state vector of the states that move: velocities first, as the axes accelerate them.
const PLANE: [usize; 6] = [at::U, at::V, at::R, at::PSI, at::X, at::Y];
const ROLL: [usize; 8] = [at::U, at::V, at::R, at::P, at::PHI, at::PSI, at::X, at::Y];
const NAMES: [&str; 8] = ["u", "v", "r", "p", "phi", "psi", "x", "y"];

/// A value on the tape and its slopes by the states, in their order; absent slopes are zero.
#[derive(Debug, Clone)]
pub(super) struct Sloped {
    pub value: usize,
    pub slopes: Vec<(usize, usize)>,
}

/// A model ready to be simulated with sensitivities.
#[derive(Debug, Clone)]
pub struct SensitiveSystem {
    pub(super) tape: Tape,
    pub(super) states: &'static [usize],
    pub(super) axes: Vec<Axis>,
    pub(super) forces: Vec<Sloped>,
    pub(super) additions: Vec<Option<Sloped>>,
    pub(super) kinematics: Vec<Sloped>,
    /// Mass matrix entries over the axes, row by row.
    mass: Vec<Option<usize>>,
    /// What a force on each axis accelerates, where masses do not change.
    constant: Option<Vec<f64>>,
    /// Regressors of the coefficients with their scale.
    pub(super) regressors: Vec<usize>,
    /// The coefficients of each axis among all.
    pub(super) of_axis: Vec<Range<usize>>,
    names: Vec<String>,
    input_names: Vec<String>,
}

impl SensitiveSystem {
    /// For every coefficient that a model has.
    ///
    /// # Errors
    /// Names what the model does not give; refuses masses that change with the motion, and effects on instruments or lags.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        let law = &*dressed(model, law)?;
        if law.inputs.len() > MAX_INPUTS || !law.dressing.lags.is_empty() || !law.dressing.measures.is_empty() {
            return Err(PlantError::Law(format!("`{}` carries a lag or an effect on instruments: no sensitivities", model.name)));
        }
        let bind = |name: &str| binding(model, law, name);
        let names: Vec<&str> = STATES.iter().map(|&(name, _)| name).chain(law.inputs.keys().map(String::as_str)).collect();
        let states: &'static [usize] = if law.has_roll() { &ROLL } else { &PLANE };
        let axes = if law.has_roll() { vec![Axis::X, Axis::Y, Axis::N, Axis::K] } else { vec![Axis::X, Axis::Y, Axis::N] };
        let builder = TapeBuilder::new(&names, &bind);
        Builder { model, law, builder, states, axes }.build()
    }

    /// The coefficients, in the order of the sensitivities' columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Places in the state vector of the sensitivities' rows.
    pub fn states(&self) -> &'static [usize] {
        self.states
    }

    /// The inputs that the law takes, in their order.
    pub fn input_names(&self) -> &[String] {
        &self.input_names
    }

    /// Accelerations per force on each axis, row by row over the axes, for a lane of an evaluated tape.
    pub(super) fn mobility<const L: usize>(&self, work: &[Lanes<L>], out: &mut [Lanes<L>]) {
        if let Some(constant) = &self.constant {
            out.iter_mut().zip(constant).for_each(|(out, value)| *out = [*value; L]);
            return;
        }
        let n = self.axes.len();
        for lane in 0..L {
            let entry = |output: Option<usize>| output.map_or(0.0, |output| self.tape.read(output, work)[lane]);
            let solved = mobility(n, |i, j| entry(self.mass[i * n + j]));
            out.iter_mut().enumerate().for_each(|(k, out)| out[lane] = solved[(k / n, k % n)]);
        }
    }
}

/// Accelerations that unit forces cause; not a number where the matrix cannot be solved.
pub(crate) fn mobility(n: usize, mass: impl Fn(usize, usize) -> f64) -> Matrix4<f64> {
    let padded = Matrix4::from_fn(|i, j| if i < n && j < n { mass(i, j) } else { f64::from(u8::from(i == j)) });
    padded.lu().solve(&Matrix4::identity()).unwrap_or_else(|| Matrix4::repeat(f64::NAN))
}

struct Builder<'a, 'b> {
    model: &'a Model,
    law: &'a Law,
    builder: TapeBuilder<'b>,
    states: &'static [usize],
    axes: Vec<Axis>,
}

impl Builder<'_, '_> {
    fn build(mut self) -> Result<SensitiveSystem, PlantError> {
        let axes = self.axes.clone();
        let forces = axes.iter().map(|&axis| self.force(axis)).collect::<Result<_, _>>()?;
        let additions = axes.iter().map(|&axis| self.addition(axis)).collect::<Result<_, _>>()?;
        let kinematics = self.states[axes.len()..].iter().map(|&state| self.kinematic(state)).collect::<Result<_, _>>()?;
        let mass = self.mass()?;
        let (names, of_axis, regressors) = self.regressors()?;
        let tape = self.builder.finish();
        let entries: Option<Vec<f64>> = mass.iter().map(|o| o.map_or(Some(0.0), |o| tape.constant_output(o))).collect();
        let n = axes.len();
        let constant = entries.map(|entries| {
            let solved = mobility(n, |i, j| entries[i * n + j]);
            (0..n * n).map(|k| solved[(k / n, k % n)]).collect::<Vec<f64>>()
        });
        if constant.as_ref().is_some_and(|constant| constant.iter().any(|value| !value.is_finite())) {
            return Err(PlantError::Mass(self.model.name.clone()));
        }
        let input_names = self.law.inputs.keys().cloned().collect();
        let (states, axes) = (self.states, self.axes);
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

    fn output(&mut self, expr: &Expr) -> Result<usize, PlantError> {
        let (law, model) = (&self.law.name, &self.model.name);
        self.builder.output(expr).map_err(|name| PlantError::Missing { law: law.clone(), name, model: model.clone() })
    }

    fn sloped(&mut self, expr: &Expr) -> Result<Sloped, PlantError> {
        let value = self.output(expr)?;
        let by = |(row, &place): (usize, &usize)| Some((row, self.builder.derivative(value, NAMES[place])?));
        let slopes = self.states.iter().enumerate().filter_map(by).collect();
        Ok(Sloped { value, slopes })
    }

    fn force(&mut self, axis: Axis) -> Result<Sloped, PlantError> {
        let expr = force(self.model, self.law, axis)?;
        self.sloped(&expr)
    }

    fn addition(&mut self, axis: Axis) -> Result<Option<Sloped>, PlantError> {
        let added = self.law.dressing.accelerations.iter().filter(|(of, _)| *of == axis).map(|(_, expr)| expr.clone());
        let sum = added.reduce(|a, b| Expr::Add(Box::new(a), Box::new(b)));
        sum.map(|sum| self.sloped(&sum)).transpose()
    }

    fn kinematic(&mut self, state: usize) -> Result<Sloped, PlantError> {
        let (name, plain) = match state {
            at::PHI => ("phi", "p"),
            at::PSI => ("psi", "r"),
            at::X => ("x", "u*cos(psi) - v*sin(psi)"),
            _ => ("y", "u*sin(psi) + v*cos(psi)"),
        };
        let plain = || parse(plain).map_err(PlantError::Law);
        let expr = self.law.kinematics.get(name).cloned().map_or_else(plain, Ok)?;
        self.sloped(&expr)
    }

    fn mass(&mut self) -> Result<Vec<Option<usize>>, PlantError> {
        let pairs: Vec<(Axis, Axis)> =
            self.axes.iter().flat_map(|&row| self.axes.iter().map(move |&column| (row, column))).collect();
        let mut all = Vec::new();
        for pair in pairs {
            let output = match self.law.mass.get(&pair) {
                Some(expr) => Some(self.output(&expr.clone())?),
                None => None,
            };
            let moves = output.is_some_and(|o| self.states.iter().any(|&s| self.builder.derivative(o, NAMES[s]).is_some()));
            if moves {
                return Err(PlantError::Law(format!(
                    "masses of law `{}` change with the motion: no sensitivities",
                    self.law.name
                )));
            }
            all.push(output);
        }
        Ok(all)
    }

    #[allow(clippy::type_complexity)]
    fn regressors(&mut self) -> Result<(Vec<String>, Vec<Range<usize>>, Vec<usize>), PlantError> {
        let (mut names, mut of_axis, mut outputs) = (Vec::new(), Vec::new(), Vec::new());
        for axis in self.axes.clone() {
            let start = names.len();
            let prefix = format!("{axis}_");
            let own: Vec<String> = self.model.coefficients.keys().filter(|name| name.starts_with(&prefix)).cloned().collect();
            for name in own {
                let (_, expr) = self.law.regressor(&name).map_err(PlantError::Law)?;
                outputs.push(self.output(&expr)?);
                names.push(name);
            }
            of_axis.push(start..names.len());
        }
        Ok((names, of_axis, outputs))
    }
}
