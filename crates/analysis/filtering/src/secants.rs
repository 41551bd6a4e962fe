//! Finite differences for parameters whose derivative at the absence of their effect is zero, and
//! for lags and dead bands.

use sistership_model::effect::EffectParameter;
use sistership_model::law::STATES;
use sistership_simulation::tape::{Direction, Lanes, Slots};

use super::ResidualSystem;
use super::followed::Followed;
use super::lanes::{LANES, lanes};
use super::path::RecordedPath;
use super::sample_block::SampleBlock;

/// A moved input of the tape, and the increment of the column's parameter.
struct Secant {
    /// Index among the parameters of all candidates.
    parameter: usize,
    moved: Moved,
    by: f64,
    direction: Direction<LANES>,
}

/// Target of a moved input.
#[derive(Clone, Copy)]
enum Moved {
    /// Input of the law with a longer lag or a wider band.
    Followed { input: usize },
    /// Parameter of the tape at a value.
    To { input: usize, value: f64 },
}

impl Moved {
    fn input(self) -> usize {
        match self {
            Self::Followed { input } => STATES.len() + input,
            Self::To { input, .. } => input,
        }
    }
}

/// Secants of a path.
pub(super) struct Secants {
    all: Vec<Secant>,
    inputs: Vec<Lanes<LANES>>,
    there: Slots<LANES>,
}

impl Secants {
    pub fn new(system: &ResidualSystem, path: &RecordedPath<'_>) -> Self {
        let candidates = system.columns.candidates.iter();
        let parameters = candidates.flat_map(|c| c.at.iter().zip(c.form.parameters.values()));
        let one = |(j, (&at, parameter)): (usize, (&f64, &EffectParameter))| {
            let (moved, by) = wanted(system, path, j, at, parameter)?;
            let direction = system.motion.tape.along(moved.input());
            Some(Secant { parameter: j, moved, by, direction })
        };
        let all = parameters.enumerate().filter_map(one).collect();
        Self { all, inputs: Vec::new(), there: Slots::default() }
    }

    /// Returns true if the column of a parameter is a secant.
    pub fn has(&self, parameter: usize) -> bool {
        self.all.iter().any(|secant| secant.parameter == parameter)
    }

    /// Passes to `take` the change of a block's accelerations by each parameter, axis by axis.
    pub fn along(&mut self, block: &SampleBlock<'_>, mut take: impl FnMut(usize, &[Lanes<LANES>])) {
        self.inputs.clone_from(&block.inputs);
        self.there.clone_from(&block.primal);
        for secant in &self.all {
            let input = secant.moved.input();
            self.inputs[input] = match secant.moved {
                Moved::To { value, .. } => [value; LANES],
                Moved::Followed { .. } => block.followed(secant.parameter),
            };
            // Only the slots that depend on the moved input are evaluated again, and restored
            // below.
            let tape = &block.system.motion.tape;
            tape.run_among(secant.direction.reached(), &self.inputs, &mut self.there);
            let mut slopes = block.accelerations(&self.there);
            for (there, here) in slopes.iter_mut().zip(&block.by_law) {
                *there = lanes(|k| (there[k] - here[k]) / secant.by);
            }
            take(block.system.columns.nuisance.len() + secant.parameter, &slopes);
            self.inputs[input] = block.inputs[input];
            for &slot in secant.direction.reached() {
                self.there[slot as usize] = block.primal[slot as usize];
            }
        }
    }
}

fn wanted(
    system: &ResidualSystem,
    path: &RecordedPath<'_>,
    j: usize,
    at: f64,
    parameter: &EffectParameter,
) -> Option<(Moved, f64)> {
    if let (Some((_, by)), Some(Followed { input, .. })) = (&path.followed[j], system.followed[j]) {
        return Some((Moved::Followed { input }, *by));
    }
    // At its absence such a parameter has no derivative, so its secant goes to the start of the
    // search.
    let says_nothing = at == parameter.absent && parameter.start != parameter.absent;
    let input = STATES.len() + system.inputs.len() + j;
    let moved = Moved::To { input, value: parameter.start };
    says_nothing.then_some((moved, parameter.start - parameter.absent))
}
