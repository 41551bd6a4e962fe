//! Tapes of a model, of candidate effects and of free coefficients.

use std::borrow::Cow;
use std::sync::Arc;

use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::effect::EffectForm;
use sistership_model::law::Law;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;
use sistership_simulation::branch::attached_correction;
use sistership_simulation::equations::{
    AxesAttitude, CoefficientBinding, EquationLowering, EquationsOfMotion,
};
use sistership_simulation::instruments::{THROUGH_WATER, reading_formulas, tape_input_names};
use sistership_simulation::state::RECORDED_CHANNELS;
use sistership_simulation::tape::Tape;

use super::correction::AttachedCorrection;
use super::followed::{FollowedInput, InputResponse};
use super::{FilterColumns, NuisanceKind, missing_term_name};
use sistership_identification::refine::RefineError;

/// Tapes of a model.
#[derive(Debug, Clone)]
pub struct ResidualSystem {
    /// Meaning of the columns.
    pub columns: FilterColumns,
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
    pub(super) motion: MotionTape,
    pub(super) regressors: Tape,
    pub(super) instruments: Tape,
    /// Index among the channels of each output of the instruments' tape.
    pub(super) says: Vec<usize>,
    /// For each parameter of a candidate that acts on the response to an input: the input and the
    /// kind of response.
    pub(super) followed: Vec<Option<FollowedInput>>,
    /// Learned correction of the model.
    pub(super) correction: Option<AttachedCorrection>,
}

/// Forces, masses and kinematics; after states and inputs the tape takes the parameters of the
/// candidates.
#[derive(Debug, Clone)]
pub(super) struct MotionTape {
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
        columns: FilterColumns,
        frame: VelocityFrame,
    ) -> Result<Self, RefineError> {
        let forms: Vec<_> =
            columns.candidates.iter().map(|c| (c.effect.as_str(), &*c.form)).collect();
        // The forms of all candidates are applied at once, so that one tape has every column.
        let equations =
            EquationsOfMotion::from_law(model, Cow::Owned(law.with_forms(model, &forms)));
        let build = SystemBuilder { equations: &equations, columns: &columns };
        let (axes, states) = (equations.axes(), equations.state_places());
        let channels =
            RECORDED_CHANNELS.iter().chain(&THROUGH_WATER).filter_map(|&(channel, place)| {
                Some((channel, states.iter().position(|&s| s == place)?))
            });
        let channels: Vec<(Channel, usize)> = channels.collect();
        let (instruments, says) = build.build_instruments(&channels, frame)?;
        Ok(Self {
            motion: build.build_motion()?,
            regressors: build.build_regressors()?,
            followed: build.followed_inputs(),
            correction: build.attached_correction()?,
            inputs: equations.law_inputs(),
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
    pub fn state_count(&self) -> usize {
        self.states.len()
    }

    /// Values of the candidates' parameters, in the order of their columns.
    pub fn parameter_values(&self) -> impl Iterator<Item = f64> + '_ {
        self.columns.candidates.iter().flat_map(|candidate| candidate.at.iter().copied())
    }
}

struct SystemBuilder<'a> {
    equations: &'a EquationsOfMotion<'a>,
    columns: &'a FilterColumns,
}

impl SystemBuilder<'_> {
    /// Names of the candidates' parameters in the law with applied effects.
    fn parameter_names(&self) -> Vec<String> {
        self.columns.candidates.iter().flat_map(|candidate| candidate.qualified_names()).collect()
    }

    /// Lowering of a tape that takes states, inputs and the candidates' parameters.
    fn new_lowering(&self) -> EquationLowering<'_> {
        EquationLowering::new(
            self.equations,
            &[self.equations.tape_input_names(), self.parameter_names()].concat(),
        )
    }

    fn build_motion(&self) -> Result<MotionTape, RefineError> {
        let (equations, mut lowering) = (self.equations, self.new_lowering());
        let (axes, states) = (equations.axes(), equations.state_places());
        let mut forces = Vec::new();
        for &axis in axes {
            forces.push(
                lowering.add_output(&equations.axis_force(axis, CoefficientBinding::Values)?)?,
            );
        }
        let mass = lowering.add_mass_matrix(axes)?;
        let additions = lowering.add_effect_accelerations(axes)?;
        let mut kinematics = Vec::new();
        for &state in &states[axes.len()..] {
            // A law without roll moves in the plane, but its instruments heel with the ship: their
            // axes are turned by the recorded roll.
            kinematics.push(
                lowering.add_output(&equations.kinematic_rate(state, AxesAttitude::Heeled)?)?,
            );
        }
        Ok(MotionTape { tape: lowering.finish(), forces, mass, additions, kinematics })
    }

    fn build_regressors(&self) -> Result<Tape, RefineError> {
        let mut lowering = self.new_lowering();
        for nuisance in &self.columns.nuisance {
            let name = &nuisance.name;
            lowering.add_output(&match nuisance.kind {
                NuisanceKind::Own(_) => self.equations.scaled_regressor(name)?,
                NuisanceKind::Lacked(_) => Expr::Name(missing_term_name(name)),
                // The column of a mass follows from the tape of motion.
                NuisanceKind::Mass(..) => Expr::Number(0.0),
            })?;
        }
        Ok(lowering.finish())
    }

    fn build_instruments(
        &self,
        channels: &[(Channel, usize)],
        frame: VelocityFrame,
    ) -> Result<(Tape, Vec<usize>), RefineError> {
        let law = self.equations.law();
        let mut lowering = EquationLowering::new(
            self.equations,
            &[tape_input_names(law), self.parameter_names()].concat(),
        );
        let mut says = Vec::new();
        // Only outputs of channels that the filter knows are kept.
        for (channel, expr) in reading_formulas(law, frame) {
            if let Some(place) = channels.iter().position(|(known, _)| *known == channel) {
                lowering.add_output(&expr)?;
                says.push(place);
            }
        }
        Ok((lowering.finish(), says))
    }

    fn attached_correction(&self) -> Result<Option<AttachedCorrection>, RefineError> {
        let place = |name: &str| self.equations.law().inputs.get_index_of(name);
        let learned = attached_correction(self.equations.model())?;
        Ok(learned.map(|learned| AttachedCorrection {
            learned,
            delta: place("delta"),
            n: place("n"),
        }))
    }

    /// For each parameter, the input and the response that it changes: its form has a time constant
    /// or a dead band that depends on the parameter.
    fn followed_inputs(&self) -> Vec<Option<FollowedInput>> {
        let candidates = self.columns.candidates.iter();
        let names = candidates.flat_map(|c| c.form.parameters.keys().map(|name| (&c.form, name)));
        let of = |(form, name): (&Arc<EffectForm>, &String)| {
            let ways =
                [(InputResponse::Late, &form.lags), (InputResponse::WithinBand, &form.bands)];
            ways.into_iter().find_map(|(way, figures)| {
                let has =
                    |(_, expr): &(&String, &Expr)| expr.mentioned_names().contains(name.as_str());
                let (input, _) = figures.iter().find(has)?;
                let input = self.equations.law().inputs.get_index_of(input)?;
                Some(FollowedInput { input, way })
            })
        };
        names.map(of).collect()
    }
}
