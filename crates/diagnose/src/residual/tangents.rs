//! In which directions a model is differentiated at a sample, eight of them together.

use sistership_dynamics::state::at;
use sistership_dynamics::tape::{Lanes, Slot, Slots};
use sistership_model::law::STATES;

use super::ResidualSystem;
use super::instruments::LANES;
use super::linearised::Detail;

/// What a direction of differentiation moves, and where its derivative goes.
#[derive(Debug, Clone, Copy)]
pub(super) enum TangentSeed {
    /// Input of the tape; state of the filter.
    State(usize, usize),
    /// Input of the tape; column.
    Parameter(usize, usize),
}

impl TangentSeed {
    fn input(self) -> usize {
        let (Self::State(input, _) | Self::Parameter(input, _)) = self;
        input
    }
}

/// Directions that are differentiated together, with the part of the tape that they reach.
pub(super) struct TangentSweep {
    pub seeds: Vec<TangentSeed>,
    pub lanes: Vec<Lanes<LANES>>,
    pub reached: Vec<Slot>,
    pub tangents: Slots<LANES>,
}

impl TangentSweep {
    fn new(system: &ResidualSystem, seeds: &[TangentSeed]) -> Self {
        let tape = &system.motion.tape;
        let mut lanes = vec![[0.0; LANES]; tape.inputs().len()];
        seeds.iter().enumerate().for_each(|(lane, seed)| lanes[seed.input()][lane] = 1.0);
        let inputs: Vec<usize> = seeds.iter().map(|seed| seed.input()).collect();
        Self {
            seeds: seeds.to_vec(),
            lanes,
            reached: tape.depending_on(&inputs),
            tangents: Slots::default(),
        }
    }
}

/// States, where everything is wanted, and the parameters of candidates.
pub(super) fn sweeps(system: &ResidualSystem, detail: Detail) -> Vec<TangentSweep> {
    let states = STATES.iter().enumerate().filter_map(|(input, (name, _))| {
        let place = place_of(name);
        Some(TangentSeed::State(input, system.states.iter().position(|&state| state == place)?))
    });
    let states: Vec<TangentSeed> = states.filter(|_| detail == Detail::Whole).collect();
    let first = STATES.len() + system.inputs.len();
    let parameters = (0..system.lagged.len())
        .map(|j| TangentSeed::Parameter(first + j, system.columns.nuisance.len() + j));
    let parameters: Vec<TangentSeed> = parameters.collect();
    states
        .chunks(LANES)
        .chain(parameters.chunks(LANES))
        .map(|seeds| TangentSweep::new(system, seeds))
        .collect()
}

/// The place in the state vector of a state that laws know.
pub(super) fn place_of(name: &str) -> usize {
    match name {
        "u" => at::U,
        "v" => at::V,
        "r" => at::R,
        "p" => at::P,
        "phi" => at::PHI,
        _ => at::PSI,
    }
}
