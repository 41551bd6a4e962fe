//! Readings of the instruments and their derivatives with states and columns.

use sistership_simulation::tape::{InputDirection, LaneValues, LocalSlopes, TapeResults};

use super::ResidualSystem;
use super::lanes::LANES;
use super::linearised::{LinearisationDetail, LinearisedPart, RateResponse};
use super::path::{instrument_rate_index, instrument_state_index};
use super::sample_block::SampleBlock;
use super::thresholds::RESIDUAL;

/// Readings of the instruments at the samples of a block, and their derivatives.
pub(super) struct InstrumentBlock {
    /// Directions of differentiation: states first, then columns.
    directions: Vec<InputDirection<LANES>>,
    /// Number of directions that are states.
    states: usize,
    primal: TapeResults<LANES>,
    slopes: LocalSlopes<LANES>,
}

impl InstrumentBlock {
    pub fn new(system: &ResidualSystem, measured: &[usize], detail: LinearisationDetail) -> Self {
        let tape = &system.instruments;
        // The parameters of candidates are the last inputs of the tape, in the order of the columns
        // after the nuisance columns.
        let first = tape.input_names().len() - system.followed.len();
        let of_column = |column: &usize| first + column - system.columns.nuisance.len();
        let states = if detail == LinearisationDetail::Whole { system.states } else { &[] };
        let inputs = states.iter().map(|&state| instrument_state_index(state));
        let directions = inputs.chain(measured.iter().map(of_column));
        Self {
            directions: directions.map(|input| tape.tangent_direction(input)).collect(),
            states: states.len(),
            primal: TapeResults::default(),
            slopes: LocalSlopes::default(),
        }
    }

    /// Evaluates readings and derivatives at the samples of a block.
    pub fn evaluate(&mut self, block: &SampleBlock<'_>) {
        self.evaluate_inputs(block.system, &block.instrument_inputs());
    }

    fn evaluate_inputs(&mut self, system: &ResidualSystem, inputs: &[LaneValues<LANES>]) {
        let tape = &system.instruments;
        tape.evaluate(inputs, &mut self.primal);
        tape.compute_slopes(&self.primal, &mut self.slopes);
        for direction in &mut self.directions {
            tape.differentiate(direction, &self.primal, &self.slopes);
        }
    }

    /// Changes of the readings, and of their derivatives with the measured columns, by a unit of
    /// each state's rate. The instruments' formulas are linear in rates, so that these are the same
    /// at all samples.
    pub fn rate_responses(
        &mut self,
        block: &SampleBlock<'_>,
        part: &LinearisedPart,
        recorded: &[usize],
    ) -> Vec<RateResponse> {
        // One unit more of one rate at a time: the difference is the exact slope, as the formulas
        // are linear in rates.
        let here = self.readings_and_slopes(block.system, recorded);
        let mut all = Vec::new();
        for (state, &place) in block.system.states.iter().enumerate() {
            let mut inputs = block.instrument_inputs();
            inputs[instrument_rate_index(place)].iter_mut().for_each(|rate| *rate += 1.0);
            self.evaluate_inputs(block.system, &inputs);
            let faster = self.readings_and_slopes(block.system, recorded);
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
        self.evaluate(block);
        all
    }

    /// Readings of the channels that differ from a state (0 for the others) and their derivatives
    /// with each measured column, in the first lane.
    fn readings_and_slopes(&self, system: &ResidualSystem, recorded: &[usize]) -> Vec<f64> {
        let of = |&channel: &usize| {
            let output = system.says.iter().position(|&place| place == channel);
            let says = output.map_or(0.0, |output| self.output_reading(system, output)[0]);
            std::iter::once(says).chain(self.column_slopes(system, channel, 0))
        };
        recorded.iter().flat_map(of).collect()
    }

    /// Reading of an output's instrument, one value per lane.
    pub fn output_reading(&self, system: &ResidualSystem, output: usize) -> LaneValues<LANES> {
        system.instruments.output_lanes(output, &self.primal)
    }

    /// Derivatives of a channel with each state; those of a channel that reads a state itself are 1
    /// for that state.
    pub fn state_slopes<'s>(
        &'s self,
        system: &'s ResidualSystem,
        channel: usize,
        lane: usize,
    ) -> impl Iterator<Item = f64> + 's {
        let output = system.says.iter().position(|&place| place == channel);
        let own = system.channels[channel].1;
        self.directions[..self.states].iter().enumerate().map(move |(state, direction)| {
            output.map_or(f64::from(u8::from(state == own)), |output| {
                system.instruments.output_lanes(output, direction.tangents())[lane]
            })
        })
    }

    /// Derivatives of a channel with each measured column.
    pub fn column_slopes<'s>(
        &'s self,
        system: &'s ResidualSystem,
        channel: usize,
        lane: usize,
    ) -> impl Iterator<Item = f64> + 's {
        let output = system.says.iter().position(|&place| place == channel);
        self.directions[self.states..].iter().map(move |direction| {
            output.map_or(0.0, |output| {
                system.instruments.output_lanes(output, direction.tangents())[lane]
            })
        })
    }
}
