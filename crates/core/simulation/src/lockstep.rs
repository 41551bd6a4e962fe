//! Ships in lockstep: passages taken lane by lane, each lane with the next one as soon as its own
//! has ended.
//!
//! Every lane is calculated by itself, so that what comes out does not depend on who sails beside.

use crate::integrate::{Method, Stage};
use crate::plant::{Inputs, MAX_INPUTS, Work};
use crate::ship::Ship;
use crate::state::{StateVector, States, at, lane_of, set_lane};
use crate::tape::Lanes;

/// Something sailed step by step.
pub(crate) trait Passage {
    /// The ship's own values of the open coefficients, none where none is open.
    fn coefficients(&self) -> &[f64];

    /// The state at the beginning.
    fn start(&mut self, ship: &Ship, work: &mut Work) -> StateVector;

    /// Takes note of a state, at the beginning and after each step; answers the length of the next
    /// step, s, or that it is over.
    fn arrive(&mut self, ship: &Ship, state: &mut StateVector, work: &mut Work) -> Option<f64>;

    /// The inputs of the law at a stage of the step, the rudder being where it is.
    fn inputs(&self, ship: &Ship, stage: Stage, rudder_rad: f64) -> Inputs;

    /// How fast the rudder moves, rad/s.
    fn rudder_rate(&self, ship: &Ship, rudder_rad: f64) -> f64;
}

/// Takes every passage to its end.
pub(crate) fn sail(ship: &Ship, method: Method, passages: &mut [impl Passage]) {
    match passages.len() {
        0 => {}
        1 => Convoy::<_, 1>::new(ship, passages.iter_mut()).sail(method),
        2..=4 => Convoy::<_, 4>::new(ship, passages.iter_mut()).sail(method),
        _ => Convoy::<_, 8>::new(ship, passages.iter_mut()).sail(method),
    }
}

struct Convoy<'p, P, const N: usize> {
    ship: &'p Ship,
    waiting: std::slice::IterMut<'p, P>,
    lanes: [Option<&'p mut P>; N],
    states: States<N>,
    steps_s: Lanes<N>,
    work: Work<N>,
    own: Work,
}

impl<'p, P: Passage, const N: usize> Convoy<'p, P, N> {
    fn new(ship: &'p Ship, waiting: std::slice::IterMut<'p, P>) -> Self {
        let lanes = std::array::from_fn(|_| None);
        let (work, own) = (Work::default(), Work::default());
        Self { ship, waiting, lanes, states: [[0.0; N]; 9], steps_s: [0.0; N], work, own }
    }

    fn sail(mut self, method: Method) {
        (0..N).for_each(|lane| self.board(lane));
        while self.lanes.iter().any(Option::is_some) {
            let Self { ship, lanes, states, steps_s, work, .. } = &mut self;
            *states = method
                .steps(states, steps_s, |stage, states| rates(ship, lanes, stage, states, work));
            for lane in 0..N {
                if self.is_over(lane) {
                    self.board(lane);
                }
            }
        }
    }

    /// Takes the next passage that has a step to sail into a lane.
    fn board(&mut self, lane: usize) {
        loop {
            self.lanes[lane] = None;
            self.steps_s[lane] = 0.0;
            let Some(passage) = self.waiting.next() else { return };
            self.work.set_coefficients(lane, passage.coefficients());
            self.own.set_coefficients(0, passage.coefficients());
            let start = passage.start(self.ship, &mut self.own);
            set_lane(&mut self.states, lane, &start);
            self.lanes[lane] = Some(passage);
            if !self.is_over(lane) {
                return;
            }
        }
    }

    /// Whether the passage in a lane ends where it has arrived; an empty lane has none to end.
    fn is_over(&mut self, lane: usize) -> bool {
        let Some(passage) = &mut self.lanes[lane] else { return false };
        let mut state = lane_of(&self.states, lane);
        if self.ship.reads_instruments() {
            self.own.set_coefficients(0, passage.coefficients());
        }
        let next = passage.arrive(self.ship, &mut state, &mut self.own);
        set_lane(&mut self.states, lane, &state);
        self.steps_s[lane] = next.unwrap_or_default();
        next.is_none()
    }
}

fn rates<P: Passage, const N: usize>(
    ship: &Ship,
    lanes: &[Option<&mut P>; N],
    stage: Stage,
    states: &States<N>,
    work: &mut Work<N>,
) -> States<N> {
    let mut inputs = [[0.0; N]; MAX_INPUTS];
    let mut rudder = [0.0; N];
    for (lane, passage) in lanes.iter().enumerate() {
        let (Some(passage), angle) = (passage, states[at::DELTA][lane]) else { continue };
        let own = passage.inputs(ship, stage, angle);
        inputs
            .iter_mut()
            .zip(own)
            .take(ship.input_count())
            .for_each(|(lanes, value)| lanes[lane] = value);
        rudder[lane] = passage.rudder_rate(ship, angle);
    }
    let mut rates = ship.rates(states, &inputs, work);
    rates[at::DELTA] = rudder;
    rates
}
