//! Readings of the instruments and their derivatives with states and columns.

use sistership_simulation::tape::{Direction, Lanes, Slopes, Slots};

use super::ResidualSystem;
use super::lanes::LANES;
use super::linearised::{Detail, Linearised, RateResponse};
use super::path::{of_instruments, rate_of_instruments};
use super::sample_block::SampleBlock;
use super::thresholds::RESIDUAL;

/// Readings of the instruments at the samples of a block, and their derivatives.
pub(super) struct InstrumentBlock {
    /// Directions of differentiation: states first, then columns.
    directions: Vec<Direction<LANES>>,
    /// Number of directions that are states.
    states: usize,
    primal: Slots<LANES>,
    slopes: Slopes<LANES>,
}

impl InstrumentBlock {
    pub fn new(system: &ResidualSystem, measured: &[usize], detail: Detail) -> Self {
        let tape = &system.instruments;
        // The parameters of candidates are the last inputs of the tape, in the order of the columns
        // after the nuisance columns.
        let first = tape.inputs().len() - system.followed.len();
        let of_column = |column: &usize| first + column - system.columns.nuisance.len();
        let states = if detail == Detail::Whole { system.states } else { &[] };
        let inputs = states.iter().map(|&state| of_instruments(state));
        let directions = inputs.chain(measured.iter().map(of_column));
        Self {
            directions: directions.map(|input| tape.along(input)).collect(),
            states: states.len(),
            primal: Slots::default(),
            slopes: Slopes::default(),
        }
    }

    /// Evaluates readings and derivatives at the samples of a block.
    pub fn at(&mut self, block: &SampleBlock<'_>) {
        self.of(block.system, &block.instrument_inputs());
    }

    fn of(&mut self, system: &ResidualSystem, inputs: &[Lanes<LANES>]) {
        let tape = &system.instruments;
        tape.run(inputs, &mut self.primal);
        tape.slopes(&self.primal, &mut self.slopes);
        for direction in &mut self.directions {
            tape.differentiate(direction, &self.primal, &self.slopes);
        }
    }

    /// Changes of the readings, and of their derivatives with the measured columns, by a unit of
    /// each state's rate. The instruments' formulas are linear in rates, so that these are the same
    /// at all samples.
    pub fn by_rate(
        &mut self,
        block: &SampleBlock<'_>,
        part: &Linearised,
        recorded: &[usize],
    ) -> Vec<RateResponse> {
        // One unit more of one rate at a time: the difference is the exact slope, as the formulas
        // are linear in rates.
        let here = self.says_and_columns(block.system, recorded);
        let mut all = Vec::new();
        for (state, &place) in block.system.states.iter().enumerate() {
            let mut inputs = block.instrument_inputs();
            inputs[rate_of_instruments(place)].iter_mut().for_each(|rate| *rate += 1.0);
            self.of(block.system, &inputs);
            let faster = self.says_and_columns(block.system, recorded);
            let width = 1 + part.measured.len();
            for (at, (faster, here)) in faster.iter().zip(&here).enumerate() {
                let by = faster - here;
                if by.abs() > RESIDUAL.least_rate_response {
                    let column = (at % width).checked_sub(1).map(|place| part.measured[place]);
                    let by = vec![by; part.samples.len()];
                    all.push(RateResponse { channel: at / width, column, state, by });
                }
            }
        }
        // Restores the block's own point after the moved evaluations.
        self.at(block);
        all
    }

    /// Readings of the channels that differ from a state (0 for the others) and their derivatives
    /// with each measured column, in the first lane.
    fn says_and_columns(&self, system: &ResidualSystem, recorded: &[usize]) -> Vec<f64> {
        let of = |&channel: &usize| {
            let output = system.says.iter().position(|&place| place == channel);
            let says = output.map_or(0.0, |output| self.says(system, output)[0]);
            std::iter::once(says).chain(self.by_column(system, channel, 0))
        };
        recorded.iter().flat_map(of).collect()
    }

    /// Reading of an output's instrument, one value per lane.
    pub fn says(&self, system: &ResidualSystem, output: usize) -> Lanes<LANES> {
        system.instruments.read(output, &self.primal)
    }

    /// Derivatives of a channel with each state; those of a channel that reads a state itself are 1
    /// for that state.
    pub fn by_state<'s>(
        &'s self,
        system: &'s ResidualSystem,
        channel: usize,
        lane: usize,
    ) -> impl Iterator<Item = f64> + 's {
        let output = system.says.iter().position(|&place| place == channel);
        let own = system.channels[channel].1;
        self.directions[..self.states].iter().enumerate().map(move |(state, direction)| {
            output.map_or(f64::from(u8::from(state == own)), |output| {
                system.instruments.read(output, direction.tangents())[lane]
            })
        })
    }

    /// Derivatives of a channel with each measured column.
    pub fn by_column<'s>(
        &'s self,
        system: &'s ResidualSystem,
        channel: usize,
        lane: usize,
    ) -> impl Iterator<Item = f64> + 's {
        let output = system.says.iter().position(|&place| place == channel);
        self.directions[self.states..].iter().map(move |direction| {
            output.map_or(0.0, |output| system.instruments.read(output, direction.tangents())[lane])
        })
    }
}
