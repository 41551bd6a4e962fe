//! A model, the effects that may be missing and the coefficients that may move, on tapes.

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
    /// Whether instruments that follow rates follow those that the filter expects.
    pub expected_rates: bool,
    pub(super) motion: Motion,
    pub(super) regressors: Tape,
    pub(super) instruments: Tape,
    /// What instruments say: place among the channels, by output.
    pub(super) says: Vec<usize>,
    /// For each parameter of a candidate that acts on how an input is followed: which, and how.
    pub(super) followed: Vec<Option<Followed>>,
    /// What the model has learned beside its law.
    pub(super) correction: Option<Correction>,
}

/// Forces, masses and kinematics; after states and inputs the tape takes the parameters of the
/// candidates.
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
    /// For trials whose velocities are of a frame. The law is in the dress of the effects that the
    /// model carries, and keeps the regressors of nuisance terms that the model lacks
    /// ([`lacked_name`]), in N (N m) per unit.
    ///
    /// # Errors
    /// Names what the model does not give; the weights of a learned correction among it.
    pub fn new(
        model: &Model,
        law: &Law,
        columns: Columns,
        frame: VelocityFrame,
    ) -> Result<Self, RefineError> {
        let forms: Vec<_> =
            columns.candidates.iter().map(|c| (c.effect.as_str(), &*c.form)).collect();
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

    /// The same with the rates that the filter expects, or those on the path.
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
    /// Names of the candidates' parameters in the law's dress.
    fn parameters(&self) -> Vec<String> {
        self.columns.candidates.iter().flat_map(|candidate| candidate.qualified()).collect()
    }

    /// A tape that takes states, inputs and the candidates' parameters.
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
            // A law without roll moves in the plane, its instruments heel with the ship: their
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
                // Its column follows from the motion's own tape.
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

    /// A parameter acts on how the ship follows an input where its form has a time constant or a
    /// band of it that is that parameter.
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
