//! How what instruments say goes with the states and with the effects on them.

use sistership_dynamics::tape::{Lanes, Slots};

use super::ResidualSystem;
use super::linearised::Detail;
use super::path::of_instruments;

/// Directions differentiated at a time.
pub(super) const LANES: usize = 8;

/// Derivatives of what instruments say, by output: states, then columns.
pub(super) struct InstrumentJacobian {
    outputs: Vec<Vec<f64>>,
    states: usize,
    columns: usize,
}

impl InstrumentJacobian {
    pub fn new(
        system: &ResidualSystem,
        primal: &[Lanes<1>],
        inputs: usize,
        measured: &[usize],
        detail: Detail,
    ) -> Self {
        let of_state = |&state: &usize| of_instruments(state);
        let first = inputs - system.lagged.len();
        let of_column = |column: &usize| first + column - system.columns.nuisance.len();
        let states = if detail == Detail::Whole { system.states } else { &[] };
        let seeds: Vec<usize> =
            states.iter().map(of_state).chain(measured.iter().map(of_column)).collect();
        let mut outputs = vec![Vec::new(); system.says.len()];
        let mut work = Slots::default();
        for chunk in seeds.chunks(LANES) {
            let mut moved = vec![[0.0; LANES]; inputs];
            chunk.iter().enumerate().for_each(|(lane, &input)| moved[input][lane] = 1.0);
            system.instruments.tangents(primal, &moved, &mut work);
            for (output, row) in outputs.iter_mut().enumerate() {
                row.extend(&system.instruments.read(output, &work)[..chunk.len()]);
            }
        }
        Self { outputs, states: states.len(), columns: measured.len() }
    }

    pub fn by_state(&self, system: &ResidualSystem, channel: usize) -> Vec<f64> {
        match system.says.iter().position(|&place| place == channel) {
            Some(output) => self.outputs[output][..self.states].to_vec(),
            None => (0..self.states)
                .map(|state| f64::from(u8::from(state == system.channels[channel].1)))
                .collect(),
        }
    }

    pub fn by_column(&self, system: &ResidualSystem, channel: usize) -> Vec<f64> {
        match system.says.iter().position(|&place| place == channel) {
            Some(output) => self.outputs[output][self.states..].to_vec(),
            None => vec![0.0; self.columns],
        }
    }
}
