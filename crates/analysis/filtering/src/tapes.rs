//! Tapes of a model, of candidate effects and of free coefficients.

use std::borrow::Cow;
use std::sync::Arc;

use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::effect::Form;
use sistership_model::law::Law;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;
use sistership_simulation::branch::attached;
use sistership_simulation::equations::{Attitude, Coefficients, EquationsOfMotion, Lowering};
use sistership_simulation::instruments::{THROUGH_WATER, input_names, readings};
use sistership_simulation::state::RECORDED;
use sistership_simulation::tape::Tape;

use super::correction::Correction;
use super::followed::{Followed, Following};
use super::{Columns, NuisanceKind, lacked_name};
use sistership_identification::refine::RefineError;

/// Tapes of a model.
#[derive(Debug, Clone)]
pub struct ResidualSystem {
    /// Meaning of the columns.
    pub columns: Columns,
    /// Indices of the filter's states in the state vector.
    pub states: &'static [usize],
    /// Axes whose accelerations are rates of states, in the order of the filter's first states.
    pub axes: Vec<Axis>,
    /// Channels and their indices among the filter's states.
    pub channels: Vec<(Channel, usize)>,
    /// Inputs of the law with their defaults.
    pub inputs: Vec<(String, Option<f64>)>,
    /// Velocities over the ground or through the water.
    pub frame: VelocityFrame,
    /// True if instruments that depend on rates use the rates that the filter expects.
    pub expected_rates: bool,
    pub(super) motion: Motion,
    pub(super) regressors: Tape,
    pub(super) instruments: Tape,
    /// Index among the channels of each output of the instruments' tape.
    pub(super) says: Vec<usize>,
    /// For each parameter of a candidate that acts on the response to an input: the input and the
    /// kind of response.
    pub(super) followed: Vec<Option<Followed>>,
    /// Learned correction of the model.
    pub(super) correction: Option<Correction>,
}

/// Forces, masses and kinematics; after states and inputs the tape takes the parameters of the
/// candidates.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    pub tape: Tape,
    pub forces: Vec<usize>,
    /// Entries of the mass matrix, row by row.
    pub mass: Vec<Option<usize>>,
    pub additions: Vec<Option<usize>>,
    /// Rates of the states after the velocities, in their order.
    pub kinematics: Vec<usize>,
}

impl ResidualSystem {
    /// Builds the tapes for trials whose velocities are relative to a frame. The effects that the
    /// model carries are applied to the law, and the regressors of nuisance terms that the model
    /// lacks are kept, in N (N m) per unit.
    ///
    /// # Errors
    /// Returns an error that names what the model does not provide, such as the weights of a
    /// learned correction.
    pub fn new(
        model: &Model,
        law: &Law,
        columns: Columns,
        frame: VelocityFrame,
    ) -> Result<Self, RefineError> {
        let forms: Vec<_> =
            columns.candidates.iter().map(|c| (c.effect.as_str(), &*c.form)).collect();
        // The forms of all candidates are applied at once, so that one tape has every column.
        let equations = EquationsOfMotion::of_law(model, Cow::Owned(law.dressed(model, &forms)));
        let build = SystemBuilder { equations: &equations, columns: &columns };
        let (axes, states) = (equations.axes(), equations.states());
        let channels = RECORDED.iter().chain(&THROUGH_WATER).filter_map(|&(channel, place)| {
            Some((channel, states.iter().position(|&s| s == place)?))
        });
        let channels: Vec<(Channel, usize)> = channels.collect();
        let (instruments, says) = build.instruments(&channels, frame)?;
        Ok(Self {
            motion: build.motion()?,
            regressors: build.regressors()?,
            followed: build.followed(),
            correction: build.correction()?,
            inputs: equations.inputs(),
            columns,
            states,
            axes: axes.to_vec(),
            channels,
            frame,
            expected_rates: false,
            instruments,
            says,
        })
    }

    /// Sets whether rates are those that the filter expects or those on the path.
    pub fn with_expected_rates(self, expected_rates: bool) -> Self {
        Self { expected_rates, ..self }
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
    equations: &'a EquationsOfMotion<'a>,
    columns: &'a Columns,
}

impl SystemBuilder<'_> {
    /// Names of the candidates' parameters in the law with applied effects.
    fn parameters(&self) -> Vec<String> {
        self.columns.candidates.iter().flat_map(|candidate| candidate.qualified()).collect()
    }

    /// Lowering of a tape that takes states, inputs and the candidates' parameters.
    fn lowering(&self) -> Lowering<'_> {
        Lowering::new(self.equations, &[self.equations.names(), self.parameters()].concat())
    }

    fn motion(&self) -> Result<Motion, RefineError> {
        let (equations, mut lowering) = (self.equations, self.lowering());
        let (axes, states) = (equations.axes(), equations.states());
        let mut forces = Vec::new();
        for &axis in axes {
            forces.push(lowering.output(&equations.force(axis, Coefficients::Values)?)?);
        }
        let mass = lowering.mass_matrix(axes)?;
        let additions = lowering.additions(axes)?;
        let mut kinematics = Vec::new();
        for &state in &states[axes.len()..] {
            // A law without roll moves in the plane, but its instruments heel with the ship: their
            // axes are turned by the recorded roll.
            kinematics.push(lowering.output(&equations.kinematic(state, Attitude::Heeled)?)?);
        }
        Ok(Motion { tape: lowering.finish(), forces, mass, additions, kinematics })
    }

    fn regressors(&self) -> Result<Tape, RefineError> {
        let mut lowering = self.lowering();
        for nuisance in &self.columns.nuisance {
            let name = &nuisance.name;
            lowering.output(&match nuisance.kind {
                NuisanceKind::Own(_) => self.equations.regressor(name)?,
                NuisanceKind::Lacked(_) => Expr::Name(lacked_name(name)),
                // The column of a mass follows from the tape of motion.
                NuisanceKind::Mass(..) => Expr::Number(0.0),
            })?;
        }
        Ok(lowering.finish())
    }

    fn instruments(
        &self,
        channels: &[(Channel, usize)],
        frame: VelocityFrame,
    ) -> Result<(Tape, Vec<usize>), RefineError> {
        let law = self.equations.law();
        let mut lowering =
            Lowering::new(self.equations, &[input_names(law), self.parameters()].concat());
        let mut says = Vec::new();
        // Only outputs of channels that the filter knows are kept.
        for (channel, expr) in readings(law, frame) {
            if let Some(place) = channels.iter().position(|(known, _)| *known == channel) {
                lowering.output(&expr)?;
                says.push(place);
            }
        }
        Ok((lowering.finish(), says))
    }

    fn correction(&self) -> Result<Option<Correction>, RefineError> {
        let place = |name: &str| self.equations.law().inputs.get_index_of(name);
        let learned = attached(self.equations.model())?;
        Ok(learned.map(|learned| Correction { learned, delta: place("delta"), n: place("n") }))
    }

    /// For each parameter, the input and the response that it changes: its form has a time constant
    /// or a dead band that depends on the parameter.
    fn followed(&self) -> Vec<Option<Followed>> {
        let candidates = self.columns.candidates.iter();
        let names = candidates.flat_map(|c| c.form.parameters.keys().map(|name| (&c.form, name)));
        let of = |(form, name): (&Arc<Form>, &String)| {
            let ways = [(Following::Late, &form.lags), (Following::WithinBand, &form.bands)];
            ways.into_iter().find_map(|(way, figures)| {
                let has = |(_, expr): &(&String, &Expr)| expr.names().contains(name.as_str());
                let (input, _) = figures.iter().find(has)?;
                let input = self.equations.law().inputs.get_index_of(input)?;
                Some(Followed { input, way })
            })
        };
        names.map(of).collect()
    }
}
