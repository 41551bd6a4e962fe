//! Sisters that sail side by side under the same orders, step by step, as the orders come.

use crate::integrate::Method;
use crate::plant::{Inputs, MAX_INPUTS, Work};
use crate::ship::Ship;
use crate::state::{StateVector, States, at, lane_of, set_lane};

/// Ships that are calculated together.
const TOGETHER: usize = 8;

/// Sisters side by side, each in a state of its own. One whose motion leaves the physical range
/// drops out; the others sail on.
#[derive(Debug)]
pub struct SideBySide {
    blocks: Vec<Block>,
}

#[derive(Debug)]
struct Block {
    states: States<TOGETHER>,
    work: Work<TOGETHER>,
    /// Who sails: lanes beyond the last ship, and those who dropped out, do not.
    sailing: [bool; TOGETHER],
}

impl SideBySide {
    /// Sisters in one state; `coefficients` as [`Ship::sister`] gives them.
    pub fn new(coefficients: &[Vec<f64>], start: &StateVector) -> Self {
        let blocks = coefficients.chunks(TOGETHER).map(|chunk| Block::new(chunk, start)).collect();
        Self { blocks }
    }

    /// Sails a step: `inputs` are those of the law, in which the rudder angle is each ship's own,
    /// and `order_rad` is what its steering gear follows.
    pub fn step(&mut self, ship: &Ship, inputs: &Inputs, order_rad: f64, step_s: f64) {
        self.blocks.iter_mut().for_each(|block| block.step(ship, inputs, order_rad, step_s));
    }

    /// The states of those who sail.
    pub fn states(&self) -> impl Iterator<Item = StateVector> {
        self.blocks.iter().flat_map(|block| {
            let lanes = (0..TOGETHER).filter(|lane| block.sailing[*lane]);
            lanes.map(|lane| lane_of(&block.states, lane))
        })
    }

    /// How many are calculated at a time, by a ship alone.
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
            // A lane that nobody has is calculated with the others, and read by nobody.
            let own = coefficients.get(lane).or(coefficients.first());
            own.into_iter().for_each(|own| block.work.set_coefficients(lane, own));
            set_lane(&mut block.states, lane, start);
            block.sailing[lane] = lane < coefficients.len();
        }
        block
    }

    fn step(&mut self, ship: &Ship, inputs: &Inputs, order_rad: f64, step_s: f64) {
        let Self { states, work, sailing } = self;
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
        for (lane, sailing) in sailing.iter_mut().enumerate() {
            *sailing &= ship.envelope().check(0.0, &lane_of(states, lane)).is_ok();
        }
    }
}
