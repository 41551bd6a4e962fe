//! Finite differences for parameters whose derivative at the absence of their effect is zero, and
//! for lags and dead bands.

use sistership_model::effect::EffectParameter;
use sistership_model::law::STATES;
use sistership_simulation::tape::{InputDirection, LaneValues, TapeResults};

use super::ResidualSystem;
use super::followed::FollowedInput;
use super::lanes::{LANES, fill_lanes};
use super::path::RecordedPath;
use super::sample_block::SampleBlock;

/// A moved input of the tape, and the increment of the column's parameter.
struct ParameterSecant {
    /// Index among the parameters of all candidates.
    parameter: usize,
    moved: MovedInput,
    by: f64,
    direction: InputDirection<LANES>,
}

/// Target of a moved input.
#[derive(Clone, Copy)]
enum MovedInput {
    /// Input of the law with a longer lag or a wider band.
    Followed { input: usize },
    /// Parameter of the tape at a value.
    To { input: usize, value: f64 },
}

impl MovedInput {
    fn tape_input(self) -> usize {
        match self {
            Self::Followed { input } => STATES.len() + input,
            Self::To { input, .. } => input,
        }
    }
}

/// Secants of a path.
pub(super) struct ParameterSecants {
    all: Vec<ParameterSecant>,
    inputs: Vec<LaneValues<LANES>>,
    there: TapeResults<LANES>,
}

impl ParameterSecants {
    pub fn new(system: &ResidualSystem, path: &RecordedPath<'_>) -> Self {
        let candidates = system.columns.candidates.iter();
        let parameters = candidates.flat_map(|c| c.at.iter().zip(c.form.parameters.values()));
        let one = |(j, (&at, parameter)): (usize, (&f64, &EffectParameter))| {
            let (moved, by) = find_secant(system, path, j, at, parameter)?;
            let direction = system.motion.tape.tangent_direction(moved.tape_input());
            Some(ParameterSecant { parameter: j, moved, by, direction })
        };
        let all = parameters.enumerate().filter_map(one).collect();
        Self { all, inputs: Vec::new(), there: TapeResults::default() }
    }

    /// Returns true if the column of a parameter is a secant.
    pub fn covers_parameter(&self, parameter: usize) -> bool {
        self.all.iter().any(|secant| secant.parameter == parameter)
    }

    /// Passes to `take` the change of a block's accelerations by each parameter, axis by axis.
    pub fn evaluate_secants(
        &mut self,
        block: &SampleBlock<'_>,
        mut take: impl FnMut(usize, &[LaneValues<LANES>]),
    ) {
        self.inputs.clone_from(&block.inputs);
        self.there.clone_from(&block.primal);
        for secant in &self.all {
            let input = secant.moved.tape_input();
            self.inputs[input] = match secant.moved {
                MovedInput::To { value, .. } => [value; LANES],
                MovedInput::Followed { .. } => block.moved_input_values(secant.parameter),
            };
            // Only the slots that depend on the moved input are evaluated again, and restored
            // below.
            let tape = &block.system.motion.tape;
            tape.evaluate_among(secant.direction.reached_slots(), &self.inputs, &mut self.there);
            let mut slopes = block.accelerations_from(&self.there);
            for (there, here) in slopes.iter_mut().zip(&block.by_law) {
                *there = fill_lanes(|k| (there[k] - here[k]) / secant.by);
            }
            take(block.system.columns.nuisance.len() + secant.parameter, &slopes);
            self.inputs[input] = block.inputs[input];
            for &slot in secant.direction.reached_slots() {
                self.there[slot as usize] = block.primal[slot as usize];
            }
        }
    }
}

fn find_secant(
    system: &ResidualSystem,
    path: &RecordedPath<'_>,
    j: usize,
    at: f64,
    parameter: &EffectParameter,
) -> Option<(MovedInput, f64)> {
    if let (Some((_, by)), Some(FollowedInput { input, .. })) =
        (&path.followed[j], system.followed[j])
    {
        return Some((MovedInput::Followed { input }, *by));
    }
    // At its absence such a parameter has no derivative, so its secant goes to the start of the
    // search.
    let says_nothing = at == parameter.absent && parameter.start != parameter.absent;
    let input = STATES.len() + system.inputs.len() + j;
    let moved = MovedInput::To { input, value: parameter.start };
    says_nothing.then_some((moved, parameter.start - parameter.absent))
}
