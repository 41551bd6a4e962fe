//! How what instruments say goes with the states and with the effects on them.

use sistership_simulation::tape::{Direction, Lanes, Slopes, Slots};

use super::ResidualSystem;
use super::lanes::LANES;
use super::linearised::{Detail, Linearised, RateResponse};
use super::path::{of_instruments, rate_of_instruments};
use super::sample_block::SampleBlock;
use super::thresholds::RESIDUAL;

/// What instruments say at the samples of a block, and its derivatives.
pub(super) struct InstrumentBlock {
    /// By states, then by columns.
    directions: Vec<Direction<LANES>>,
    /// How many of the directions are states.
    states: usize,
    primal: Slots<LANES>,
    slopes: Slopes<LANES>,
}

impl InstrumentBlock {
    pub fn new(system: &ResidualSystem, measured: &[usize], detail: Detail) -> Self {
        let tape = &system.instruments;
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

    /// Evaluates them where a block is.
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

    /// What instruments say more, as they are and by each measured column, where states change
    /// faster: their formulas are linear in rates, so that it is the same at all samples.
    pub fn by_rate(
        &mut self,
        block: &SampleBlock<'_>,
        part: &Linearised,
        recorded: &[usize],
    ) -> Vec<RateResponse> {
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
        self.at(block);
        all
    }

    /// What each channel says that does not say a state, and more by each measured column, in the
    /// first lane.
    fn says_and_columns(&self, system: &ResidualSystem, recorded: &[usize]) -> Vec<f64> {
        let of = |&channel: &usize| {
            let output = system.says.iter().position(|&place| place == channel);
            let says = output.map_or(0.0, |output| self.says(system, output)[0]);
            std::iter::once(says).chain(self.by_column(system, channel, 0))
        };
        recorded.iter().flat_map(of).collect()
    }

    /// What the instrument of an output says.
    pub fn says(&self, system: &ResidualSystem, output: usize) -> Lanes<LANES> {
        system.instruments.read(output, &self.primal)
    }

    /// What a channel says more by each state; a channel that says a state follows that alone.
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

    /// What a channel says more by each measured column.
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
