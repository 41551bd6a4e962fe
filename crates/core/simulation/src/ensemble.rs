//! Ships that are simulated together under the same orders, step by step, as the orders arrive.

use crate::integrate::Method;
use crate::plant::{LawInputs, MAX_INPUTS, PlantWorkspace};
use crate::ship::{HelmOrder, Ship};
use crate::state::{LaneStates, StateVector, at, lane_of, set_lane};

/// Number of ships that are calculated together.
const BLOCK_SIZE: usize = 8;

/// Ensemble of ships that differ in their coefficients, each with its own state. A ship whose
/// motion leaves the physical range drops out; the others continue.
#[derive(Debug)]
pub struct ShipEnsemble {
    blocks: Vec<ShipBlock>,
}

#[derive(Debug)]
struct ShipBlock {
    states: LaneStates<BLOCK_SIZE>,
    work: PlantWorkspace<BLOCK_SIZE>,
    /// Active lanes; lanes beyond the last ship, and those of ships that dropped out, are not
    /// active.
    sailing: [bool; BLOCK_SIZE],
}

impl ShipEnsemble {
    /// Creates an ensemble in one state; `coefficients` as returned by [`Ship::sister`].
    pub fn new(coefficients: &[Vec<f64>], start: &StateVector) -> Self {
        let blocks =
            coefficients.chunks(BLOCK_SIZE).map(|chunk| ShipBlock::new(chunk, start)).collect();
        Self { blocks }
    }

    /// Advances all ships by a step under an order. `inputs` returns those of the law at a helm
    /// angle, which differs from ship to ship.
    pub fn advance_step(
        &mut self,
        ship: &Ship,
        inputs: &dyn Fn(f64) -> LawInputs,
        order: HelmOrder,
        step_s: f64,
    ) {
        self.blocks.iter_mut().for_each(|block| block.advance_step(ship, inputs, order, step_s));
    }

    /// States of the active ships.
    pub fn active_states(&self) -> impl Iterator<Item = StateVector> {
        self.blocks.iter().flat_map(|block| {
            let lanes = (0..BLOCK_SIZE).filter(|lane| block.sailing[*lane]);
            lanes.map(|lane| lane_of(&block.states, lane))
        })
    }

    /// Number of blocks, each of which takes about the time of a single ship.
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }
}

impl ShipBlock {
    fn new(coefficients: &[Vec<f64>], start: &StateVector) -> Self {
        let mut block = Self {
            states: [[0.0; BLOCK_SIZE]; 9],
            work: PlantWorkspace::default(),
            sailing: [false; BLOCK_SIZE],
        };
        for lane in 0..BLOCK_SIZE {
            // An unused lane is calculated with the others, but its result is not read.
            let own = coefficients.get(lane).or(coefficients.first());
            own.into_iter().for_each(|own| block.work.set_coefficients(lane, own));
            set_lane(&mut block.states, lane, start);
            block.sailing[lane] = lane < coefficients.len();
        }
        block
    }

    fn advance_step(
        &mut self,
        ship: &Ship,
        inputs: &dyn Fn(f64) -> LawInputs,
        order: HelmOrder,
        step_s: f64,
    ) {
        let Self { states, work, sailing } = self;
        // The order is constant over the step; only the helm angle differs between stages.
        *states = Method::Rk4.advance_states(states, &[step_s; BLOCK_SIZE], |_, states| {
            let of_lanes = states[at::DELTA].map(inputs);
            let lanes: [[f64; BLOCK_SIZE]; MAX_INPUTS] =
                std::array::from_fn(|place| of_lanes.map(|of_lane| of_lane[place]));
            let mut rates = ship.state_rates(states, &lanes, work);
            rates[at::DELTA] =
                states[at::DELTA].map(|angle| ship.rudder_rate(order.delta_rad, angle, step_s));
            rates
        });
        // A ship that has dropped out stays inactive, also if its state returned to the range.
        for (lane, sailing) in sailing.iter_mut().enumerate() {
            *sailing &= ship.envelope().check_state(0.0, &lane_of(states, lane)).is_ok();
        }
    }
}
