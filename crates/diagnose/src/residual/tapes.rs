//! A model, the effects that may be missing and the coefficients that may move, on tapes.

use sistership_dynamics::instruments::{input_names, readings};
use sistership_dynamics::plant::binding;
use sistership_dynamics::state::{RECORDED, at};
use sistership_dynamics::tape::{Tape, TapeBuilder};
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::formula::Expr;
use sistership_model::law::{Law, STATES};
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;

use super::{Columns, NuisanceKind, lacked_name};
use sistership_estimate::refine::RefineError;

/// Places of the states in a filter: `u, v, r`, then roll where the law has it, then `psi, x, y`.
const PLANE: [usize; 6] = [at::U, at::V, at::R, at::PSI, at::X, at::Y];
const ROLL: [usize; 8] = [at::U, at::V, at::R, at::P, at::PHI, at::PSI, at::X, at::Y];

/// A model on tapes.
#[derive(Debug, Clone)]
pub struct ResidualSystem {
    /// What the columns stand for.
    pub columns: Columns,
    /// Places in the state vector of the filter's states.
    pub states: &'static [usize],
    /// Axes whose accelerations are states' rates, in the order of the filter's first states.
    pub axes: Vec<Axis>,
    /// Channels and their places among the filter's states.
    pub channels: Vec<(Channel, usize)>,
    /// Inputs of the law with their defaults.
    pub inputs: Vec<(String, Option<f64>)>,
    /// Velocities over the ground or through the water.
    pub frame: VelocityFrame,
    pub(super) motion: Motion,
    pub(super) regressors: Tape,
    pub(super) instruments: Tape,
    /// What instruments say: place among the channels, by output.
    pub(super) says: Vec<usize>,
    /// For each parameter of a candidate that acts through a lag: the input it delays.
    pub(super) lagged: Vec<Option<usize>>,
}

/// Forces, masses and kinematics; after states and inputs the tape takes the parameters of the candidates.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    pub tape: Tape,
    pub forces: Vec<usize>,
    /// Row by row.
    pub mass: Vec<Option<usize>>,
    pub additions: Vec<Option<usize>>,
    /// Rates of the states after the velocities, in their order.
    pub kinematics: Vec<usize>,
}

impl ResidualSystem {
    /// For trials whose velocities are of a frame. The law is in the dress of the effects that the model carries, and keeps
    /// the regressors of nuisance terms that the model lacks ([`lacked_name`]), in N (N m) per unit.
    ///
    /// # Errors
    /// Names what the model does not give.
    pub fn new(model: &Model, law: &Law, columns: Columns, frame: VelocityFrame) -> Result<Self, RefineError> {
        let forms: Vec<_> = columns.candidates.iter().map(|c| (c.effect.as_str(), &*c.form)).collect();
        let law = law.dressed(model, &forms);
        let build = SystemBuilder { model, law: &law, columns: &columns };
        let axes = if law.has_roll() { vec![Axis::X, Axis::Y, Axis::N, Axis::K] } else { vec![Axis::X, Axis::Y, Axis::N] };
        let states: &'static [usize] = if law.has_roll() { &ROLL } else { &PLANE };
        let channels = RECORDED.iter().filter_map(|&(channel, place)| Some((channel, states.iter().position(|&s| s == place)?)));
        let channels: Vec<(Channel, usize)> = channels.collect();
        let (instruments, says) = build.instruments(&channels, frame)?;
        Ok(Self {
            motion: build.motion(&axes, states)?,
            regressors: build.regressors()?,
            lagged: build.lagged(),
            inputs: law.inputs.iter().map(|(name, input)| (name.clone(), input.default)).collect(),
            columns,
            states,
            axes,
            channels,
            frame,
            instruments,
            says,
        })
    }

    /// Number of the filter's states without discrepancies.
    pub fn order(&self) -> usize {
        self.states.len()
    }

    /// Values of the candidates' parameters, in the order of their columns.
    pub fn parameters(&self) -> impl Iterator<Item = f64> + '_ {
        self.columns.candidates.iter().flat_map(|candidate| candidate.at.iter().copied())
    }
}

struct SystemBuilder<'a> {
    model: &'a Model,
    law: &'a Law,
    columns: &'a Columns,
}

impl SystemBuilder<'_> {
    fn names(&self, parameters: bool) -> Vec<String> {
        let states = STATES.iter().map(|&(name, _)| name.to_owned());
        let names = states.chain(self.law.inputs.keys().cloned());
        let extra = self.columns.candidates.iter().flat_map(|candidate| candidate.qualified().collect::<Vec<_>>());
        names.chain(extra.filter(|_| parameters)).collect()
    }

    fn missing(&self, name: String) -> RefineError {
        RefineError::Missing { law: self.law.name.clone(), name, model: self.model.name.clone() }
    }

    fn build<T>(
        &self,
        names: &[String],
        fill: impl FnOnce(&mut dyn FnMut(&Expr) -> Result<usize, RefineError>) -> Result<T, RefineError>,
    ) -> Result<(Tape, T), RefineError> {
        let bind = |name: &str| binding(self.model, self.law, name);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let mut builder = TapeBuilder::new(&names, &bind);
        let filled = fill(&mut |expr| builder.output(expr).map_err(|name| self.missing(name)))?;
        Ok((builder.finish(), filled))
    }

    fn motion(&self, axes: &[Axis], states: &[usize]) -> Result<Motion, RefineError> {
        let (tape, mut motion) = self.build(&self.names(true), |output| {
            let forces = axes.iter().map(|&axis| output(&self.force(axis)?)).collect::<Result<_, _>>()?;
            let pairs = axes.iter().flat_map(|&row| axes.iter().map(move |&column| (row, column)));
            let mass = pairs.map(|pair| self.law.mass.get(&pair).map(&mut *output).transpose()).collect::<Result<_, _>>()?;
            let additions =
                axes.iter().map(|&axis| self.addition(axis).map(|e| output(&e)).transpose()).collect::<Result<_, _>>()?;
            let kinematics =
                states[axes.len()..].iter().map(|&state| output(&self.kinematic(state)?)).collect::<Result<_, _>>()?;
            Ok(Motion { tape: Tape::default(), forces, mass, additions, kinematics })
        })?;
        motion.tape = tape;
        Ok(motion)
    }

    fn force(&self, axis: Axis) -> Result<Expr, RefineError> {
        Ok(sistership_dynamics::plant::force(self.model, self.law, axis)?)
    }

    fn addition(&self, axis: Axis) -> Option<Expr> {
        let of_axis = self.law.dressing.accelerations.iter().filter(|(a, _)| *a == axis).map(|(_, expr)| expr.clone());
        of_axis.reduce(|sum, expr| Expr::Add(Box::new(sum), Box::new(expr)))
    }

    fn kinematic(&self, state: usize) -> Result<Expr, RefineError> {
        // A law without roll moves in the plane, her instruments heel with her: their axes are turned by the recorded roll.
        let (name, plain) = match state {
            at::PHI => ("phi", "p"),
            at::PSI => ("psi", "r*cos(phi)"),
            at::X => ("x", "u*cos(psi) - v*sin(psi)*cos(phi)"),
            _ => ("y", "u*sin(psi) + v*cos(psi)*cos(phi)"),
        };
        match self.law.kinematics.get(name) {
            Some(expr) => Ok(expr.clone()),
            None => sistership_model::formula::parse(plain).map_err(RefineError::Law),
        }
    }

    fn regressors(&self) -> Result<Tape, RefineError> {
        let (tape, ()) = self.build(&self.names(true), |output| {
            for nuisance in &self.columns.nuisance {
                let name = &nuisance.name;
                output(&match nuisance.kind {
                    NuisanceKind::Own(_) => self.law.regressor(name).map_err(RefineError::Law)?.1,
                    NuisanceKind::Lacked(_) => Expr::Name(lacked_name(name)),
                    // Its column follows from the motion's own tape.
                    NuisanceKind::Mass(..) => Expr::Number(0.0),
                })?;
            }
            Ok(())
        })?;
        Ok(tape)
    }

    fn instruments(&self, channels: &[(Channel, usize)], frame: VelocityFrame) -> Result<(Tape, Vec<usize>), RefineError> {
        let extra = self.columns.candidates.iter().flat_map(|candidate| candidate.qualified().collect::<Vec<_>>());
        let names: Vec<String> = input_names(self.law).into_iter().chain(extra).collect();
        self.build(&names, |output| {
            let mut says = Vec::new();
            for (channel, expr) in readings(self.law, frame) {
                if let Some(place) = channels.iter().position(|(known, _)| *known == channel) {
                    output(&expr)?;
                    says.push(place);
                }
            }
            Ok(says)
        })
    }

    /// A parameter acts through a lag where its form delays an input by a time constant that is that parameter.
    fn lagged(&self) -> Vec<Option<usize>> {
        let mut lagged = Vec::new();
        for candidate in &self.columns.candidates {
            for name in candidate.form.parameters.keys() {
                let input = candidate.form.lags.iter().find(|(_, expr)| expr.names().contains(name.as_str()));
                lagged.push(input.and_then(|(input, _)| self.law.inputs.get_index_of(input)));
            }
        }
        lagged
    }
}
