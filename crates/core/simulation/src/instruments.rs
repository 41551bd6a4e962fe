//! What the instruments say of a state, where effects make them say something else than the truth.

use sistership_formula::Expr;
use sistership_model::law::Law;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;

use crate::equations::{EquationsOfMotion, Lowering, PlantError};
use crate::state::{RECORDED, StateVector, at};
use crate::tape::{Lanes, Slots, Tape};

/// The names that the formula of an instrument may use, with their places: states, then their
/// rates.
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

/// Instruments: for each channel that does not say the truth, what it says.
#[derive(Debug)]
pub struct Instruments {
    tape: Tape,
    /// Place in the state and output of the tape.
    says: Vec<(usize, usize)>,
}

/// Room to read in, kept from sample to sample.
#[derive(Debug, Default)]
pub struct Room {
    values: Vec<Lanes<1>>,
    work: Slots<1>,
}

impl Instruments {
    /// The instruments of trials whose velocities are of a frame; `None` where every one says the
    /// truth.
    ///
    /// # Errors
    /// Names what the model does not give.
    pub fn new(
        equations: &EquationsOfMotion<'_>,
        frame: VelocityFrame,
    ) -> Result<Option<Self>, PlantError> {
        let law = equations.law();
        let mut lowering = Lowering::new(equations, &input_names(law));
        let mut says = Vec::new();
        for (channel, expr) in readings(law, frame) {
            let Some(&(_, place)) = RECORDED.iter().find(|(known, _)| *known == channel) else {
                continue;
            };
            says.push((place, lowering.output(&expr)?));
        }
        Ok((!says.is_empty()).then(|| Self { tape: lowering.finish(), says }))
    }

    /// What they say of a state with its rate of change.
    pub fn read(
        &self,
        state: &StateVector,
        rate: &StateVector,
        inputs: &[f64],
        room: &mut Room,
    ) -> StateVector {
        let Room { values, work } = room;
        values.clear();
        values.extend(STATES.iter().map(|&(_, place)| [state[place]]));
        values.extend(STATES.iter().map(|&(_, place)| [rate[place]]));
        values.extend(inputs.iter().map(|&value| [value]));
        self.tape.run(values, work);
        let mut said = *state;
        self.says.iter().for_each(|&(place, output)| said[place] = self.tape.read(output, work)[0]);
        said
    }
}

/// The names of the tape of instruments: states, their rates, the inputs of the law.
pub fn input_names(law: &Law) -> Vec<String> {
    let states = STATES.iter().map(|(name, _)| (*name).to_owned());
    let rates = STATES.iter().map(|(name, _)| format!("{name}_dot"));
    states.chain(rates).chain(law.inputs.keys().cloned()).collect()
}

/// The channels of speeds through the water beside those over the ground, with their places.
pub const THROUGH_WATER: [(Channel, usize); 2] =
    [(Channel::UWater, at::U), (Channel::VWater, at::V)];

/// What each channel says, where it is not the truth: a log that measures through the water says
/// what the hull sees.
pub fn readings(law: &Law, frame: VelocityFrame) -> Vec<(Channel, Expr)> {
    let ground = [Channel::U, Channel::V];
    let logs = THROUGH_WATER.map(|(log, _)| log).into_iter().zip(ground);
    let axes = ground.into_iter().zip(ground).filter(|_| frame == VelocityFrame::Water);
    let through_water = axes.chain(logs.clone());
    let mut readings: Vec<(Channel, Expr)> =
        through_water.filter_map(|(log, own)| Some((log, seen(law, own)?))).collect();
    for (channel, expr) in &law.dressing.measures {
        match readings.iter_mut().find(|(known, _)| known == channel) {
            // The second effect acts on what the first one left.
            Some((_, before)) => *before = expr_of(expr, *channel, before),
            None => {
                let own = logs.clone().find(|(log, _)| log == channel).map(|(_, own)| own);
                let truth = Expr::Name(own.unwrap_or(*channel).name().into());
                readings.push((*channel, expr_of(expr, *channel, &truth)));
            }
        }
    }
    readings
}

/// An instrument's formula, of what it would say without an error.
fn expr_of(expr: &Expr, channel: Channel, without_error: &Expr) -> Expr {
    expr.renamed(&|name| (name == channel.name()).then(|| without_error.clone()))
}

/// What the hull sees of a velocity over the ground; nothing where the water stands still.
fn seen(law: &Law, channel: Channel) -> Option<Expr> {
    let name = law.values.keys().find(|name| name.ends_with(&format!(".seen.{channel}")))?;
    Some(Expr::Name(name.clone()))
}

/// Rounds in which a true state is sought: few, so that it stays near what is said where an error
/// is too large for the search.
const ROUNDS: usize = 16;
/// Where the search ends, in any state.
const FOUND: f64 = 1e-9;

/// The true state of which instruments say `said`, by moving against what is said too much.
pub fn truth(said: &StateVector, mut read: impl FnMut(&StateVector) -> StateVector) -> StateVector {
    let mut state = *said;
    for _ in 0..ROUNDS {
        let error = read(&state) - said;
        state -= error;
        if error.amax() < FOUND {
            break;
        }
    }
    state
}
