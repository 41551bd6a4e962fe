//! Ships that are simulated together under the same orders, step by step, as the orders arrive.

use crate::integrate::Method;
use crate::plant::{Inputs, MAX_INPUTS, Work};
use crate::ship::Ship;
use crate::state::{StateVector, States, at, lane_of, set_lane};

/// Number of ships that are calculated together.
const TOGETHER: usize = 8;

/// Ensemble of ships that differ in their coefficients, each with its own state. A ship whose
/// motion leaves the physical range drops out; the others continue.
#[derive(Debug)]
pub struct SideBySide {
    blocks: Vec<Block>,
}

#[derive(Debug)]
struct Block {
    states: States<TOGETHER>,
    work: Work<TOGETHER>,
    /// Active lanes; lanes beyond the last ship, and those of ships that dropped out, are not
    /// active.
    sailing: [bool; TOGETHER],
}

impl SideBySide {
    /// Creates an ensemble in one state; `coefficients` as returned by [`Ship::sister`].
    pub fn new(coefficients: &[Vec<f64>], start: &StateVector) -> Self {
        let blocks = coefficients.chunks(TOGETHER).map(|chunk| Block::new(chunk, start)).collect();
        Self { blocks }
    }

    /// Advances all ships by a step: `inputs` are those of the law, of which the rudder angle is
    /// replaced by that of each ship, and `order_rad` is the order to its steering gear.
    pub fn step(&mut self, ship: &Ship, inputs: &Inputs, order_rad: f64, step_s: f64) {
        self.blocks.iter_mut().for_each(|block| block.step(ship, inputs, order_rad, step_s));
    }

    /// States of the active ships.
    pub fn states(&self) -> impl Iterator<Item = StateVector> {
        self.blocks.iter().flat_map(|block| {
            let lanes = (0..TOGETHER).filter(|lane| block.sailing[*lane]);
            lanes.map(|lane| lane_of(&block.states, lane))
        })
    }

    /// Number of blocks, each of which takes about the time of a single ship.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }
}

impl Block {
    fn new(coefficients: &[Vec<f64>], start: &StateVector) -> Self {
        let mut block = Self {
            states: [[0.0; TOGETHER]; 9],
            work: Work::default(),
            sailing: [false; TOGETHER],
        };
        for lane in 0..TOGETHER {
            // An unused lane is calculated with the others, but its result is not read.
            let own = coefficients.get(lane).or(coefficients.first());
            own.into_iter().for_each(|own| block.work.set_coefficients(lane, own));
            set_lane(&mut block.states, lane, start);
            block.sailing[lane] = lane < coefficients.len();
        }
        block
    }

    fn step(&mut self, ship: &Ship, inputs: &Inputs, order_rad: f64, step_s: f64) {
        let Self { states, work, sailing } = self;
        // Order and inputs are constant over the step; only the rudder angle differs between
        // stages.
        *states = Method::Rk4.steps(states, &[step_s; TOGETHER], |_, states| {
            let mut lanes: [[f64; TOGETHER]; MAX_INPUTS] = inputs.map(|value| [value; TOGETHER]);
            if let Some(place) = ship.rudder_place() {
                lanes[place] = states[at::DELTA];
            }
            let mut rates = ship.rates(states, &lanes, work);
            rates[at::DELTA] =
                states[at::DELTA].map(|angle| ship.rudder_rate(order_rad, angle, step_s));
            rates
        });
        // A ship that has dropped out stays inactive, also if its state returned to the range.
        for (lane, sailing) in sailing.iter_mut().enumerate() {
            *sailing &= ship.envelope().check(0.0, &lane_of(states, lane)).is_ok();
        }
    }
}
