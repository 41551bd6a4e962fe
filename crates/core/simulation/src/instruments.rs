//! Readings of the instruments at a state, where effects make them differ from the true values.

use sistership_formula::Expr;
use sistership_model::law::Law;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;

use crate::equations::{EquationLowering, EquationsOfMotion, PlantError};
use crate::state::{RECORDED_CHANNELS, StateVector, at};
use crate::tape::{LaneValues, Tape, TapeResults};

/// Names that the formula of an instrument may use, with their places: states, then their rates.
const STATES: [(&str, usize); 8] = [
    ("u", at::U),
    ("v", at::V),
    ("r", at::R),
    ("p", at::P),
    ("phi", at::PHI),
    ("psi", at::PSI),
    ("x", at::X),
    ("y", at::Y),
];

/// Instruments: readings of every channel that differs from the true state.
#[derive(Debug)]
pub struct InstrumentModel {
    tape: Tape,
    /// Place in the state vector and output of the tape.
    says: Vec<(usize, usize)>,
}

/// Workspace of readings, kept from sample to sample to avoid allocation.
#[derive(Debug, Default)]
pub struct InstrumentWorkspace {
    values: Vec<LaneValues<1>>,
    work: TapeResults<1>,
}

impl InstrumentModel {
    /// Creates the instruments of trials whose velocities are measured in a frame; `None` if every
    /// instrument reads the true value.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give.
    pub fn new(
        equations: &EquationsOfMotion<'_>,
        frame: VelocityFrame,
    ) -> Result<Option<Self>, PlantError> {
        let law = equations.law();
        let mut lowering = EquationLowering::new(equations, &tape_input_names(law));
        let mut says = Vec::new();
        for (channel, expr) in reading_formulas(law, frame) {
            // A channel that is not part of the state has no reading to replace.
            let Some(&(_, place)) = RECORDED_CHANNELS.iter().find(|(known, _)| *known == channel)
            else {
                continue;
            };
            says.push((place, lowering.add_output(&expr)?));
        }
        Ok((!says.is_empty()).then(|| Self { tape: lowering.finish(), says }))
    }

    /// Returns the readings at a state with its rate of change.
    pub fn read_state(
        &self,
        state: &StateVector,
        rate: &StateVector,
        inputs: &[f64],
        room: &mut InstrumentWorkspace,
    ) -> StateVector {
        let InstrumentWorkspace { values, work } = room;
        values.clear();
        values.extend(STATES.iter().map(|&(_, place)| [state[place]]));
        values.extend(STATES.iter().map(|&(_, place)| [rate[place]]));
        values.extend(inputs.iter().map(|&value| [value]));
        self.tape.evaluate(values, work);
        let mut said = *state;
        self.says
            .iter()
            .for_each(|&(place, output)| said[place] = self.tape.output_lanes(output, work)[0]);
        said
    }
}

/// Input names of the tape of instruments: states, their rates, the inputs of the law.
pub fn tape_input_names(law: &Law) -> Vec<String> {
    let states = STATES.iter().map(|(name, _)| (*name).to_owned());
    let rates = STATES.iter().map(|(name, _)| format!("{name}_dot"));
    states.chain(rates).chain(law.inputs.keys().cloned()).collect()
}

/// Channels of speeds through the water, recorded in addition to those over the ground, with their
/// places.
pub const THROUGH_WATER: [(Channel, usize); 2] =
    [(Channel::UWater, at::U), (Channel::VWater, at::V)];

/// Formulas of the channels that do not read the true value: a log that measures through the water
/// reads the velocity relative to the water.
pub fn reading_formulas(law: &Law, frame: VelocityFrame) -> Vec<(Channel, Expr)> {
    let ground = [Channel::U, Channel::V];
    // Separate channels of a log, and `u` and `v` in the frame of the water, are speeds through the
    // water.
    let logs = THROUGH_WATER.map(|(log, _)| log).into_iter().zip(ground);
    let axes = ground.into_iter().zip(ground).filter(|_| frame == VelocityFrame::Water);
    let through_water = axes.chain(logs.clone());
    let mut readings: Vec<(Channel, Expr)> =
        through_water.filter_map(|(log, own)| Some((log, relative_velocity(law, own)?))).collect();
    for (channel, expr) in &law.dressing.measures {
        match readings.iter_mut().find(|(known, _)| known == channel) {
            // The second effect on a channel acts on the reading after the first one.
            Some((_, before)) => *before = substitute_reading(expr, *channel, before),
            None => {
                // Without an error a log reads the velocity of the same direction.
                let own = logs.clone().find(|(log, _)| log == channel).map(|(_, own)| own);
                let truth = Expr::Name(own.unwrap_or(*channel).name().into());
                readings.push((*channel, substitute_reading(expr, *channel, &truth)));
            }
        }
    }
    readings
}

/// Formula of an instrument in terms of its reading without an error.
fn substitute_reading(expr: &Expr, channel: Channel, without_error: &Expr) -> Expr {
    expr.replace_names(&|name| (name == channel.name()).then(|| without_error.clone()))
}

/// Velocity relative to the water for a velocity over the ground; `None` without a current.
fn relative_velocity(law: &Law, channel: Channel) -> Option<Expr> {
    // Values of effects on the inflow are named `effect/form.seen.channel`.
    let name = law.values.keys().find(|name| name.ends_with(&format!(".seen.{channel}")))?;
    Some(Expr::Name(name.clone()))
}

/// Iterations of the search for a true state: few, so that it stays near the reading where an error
/// is too large for the search to converge.
const MAX_ITERATIONS: usize = 16;
/// Largest remaining difference in any state at which the search ends.
const TOLERANCE: f64 = 1e-9;

/// Returns the true state for the readings `said`, by fixed-point iteration: each step subtracts
/// the difference between the readings at the state and `said`.
pub fn invert_readings(
    said: &StateVector,
    mut read: impl FnMut(&StateVector) -> StateVector,
) -> StateVector {
    let mut state = *said;
    for _ in 0..MAX_ITERATIONS {
        let error = read(&state) - said;
        state -= error;
        if error.amax() < TOLERANCE {
            break;
        }
    }
    state
}
