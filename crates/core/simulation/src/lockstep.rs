//! Ships in lockstep: a batch of simulations is processed lane by lane; a lane takes the next
//! simulation as soon as its own has ended.
//!
//! Every lane is calculated independently, so that a result does not depend on the other lanes.

use crate::integrate::{Method, StepStage};
use crate::plant::{LawInputs, MAX_INPUTS, PlantWorkspace};
use crate::ship::Ship;
use crate::state::{LaneStates, StateVector, at, lane_of, set_lane};
use crate::tape::LaneValues;

/// Simulation that is carried out step by step.
pub(crate) trait SimulationTask {
    /// Values of the open coefficients; empty where none is open.
    fn coefficients(&self) -> &[f64];

    /// Returns the state at the beginning.
    fn initial_state(&mut self, ship: &Ship, work: &mut PlantWorkspace) -> StateVector;

    /// Records a state, at the beginning and after each step; returns the length of the next step,
    /// s, or `None` at the end.
    fn next_step(
        &mut self,
        ship: &Ship,
        state: &mut StateVector,
        work: &mut PlantWorkspace,
    ) -> Option<f64>;

    /// Returns the inputs of the law at a stage of the step, for the current rudder angle.
    fn stage_inputs(&self, ship: &Ship, stage: StepStage, rudder_rad: f64) -> LawInputs;

    /// Returns the rudder rate, rad/s.
    fn rudder_rate(&self, ship: &Ship, rudder_rad: f64) -> f64;
}

/// Carries out every simulation to its end.
pub(crate) fn run_batch(ship: &Ship, method: Method, passages: &mut [impl SimulationTask]) {
    match passages.len() {
        // The number of lanes is a constant of the compiled code: the smallest that fits, at most
        // 8.
        0 => {}
        1 => SimulationBatch::<_, 1>::new(ship, passages.iter_mut()).run_lanes(method),
        2..=4 => SimulationBatch::<_, 4>::new(ship, passages.iter_mut()).run_lanes(method),
        _ => SimulationBatch::<_, 8>::new(ship, passages.iter_mut()).run_lanes(method),
    }
}

struct SimulationBatch<'p, P, const N: usize> {
    ship: &'p Ship,
    waiting: std::slice::IterMut<'p, P>,
    lanes: [Option<&'p mut P>; N],
    states: LaneStates<N>,
    steps_s: LaneValues<N>,
    work: PlantWorkspace<N>,
    own: PlantWorkspace,
}

impl<'p, P: SimulationTask, const N: usize> SimulationBatch<'p, P, N> {
    fn new(ship: &'p Ship, waiting: std::slice::IterMut<'p, P>) -> Self {
        let lanes = std::array::from_fn(|_| None);
        let (work, own) = (PlantWorkspace::default(), PlantWorkspace::default());
        Self { ship, waiting, lanes, states: [[0.0; N]; 9], steps_s: [0.0; N], work, own }
    }

    fn run_lanes(mut self, method: Method) {
        (0..N).for_each(|lane| self.load_lane(lane));
        while self.lanes.iter().any(Option::is_some) {
            // Empty lanes have a step of zero and keep their state.
            let Self { ship, lanes, states, steps_s, work, .. } = &mut self;
            *states = method.advance_states(states, steps_s, |stage, states| {
                lane_rates(ship, lanes, stage, states, work)
            });
            for lane in 0..N {
                if self.finish_step(lane) {
                    self.load_lane(lane);
                }
            }
        }
    }

    /// Loads the next simulation that has a step to take into a lane.
    fn load_lane(&mut self, lane: usize) {
        loop {
            self.lanes[lane] = None;
            self.steps_s[lane] = 0.0;
            let Some(passage) = self.waiting.next() else { return };
            self.work.set_coefficients(lane, passage.coefficients());
            // `own` is the workspace of single evaluations: starting states and readings of
            // instruments.
            self.own.set_coefficients(0, passage.coefficients());
            let start = passage.initial_state(self.ship, &mut self.own);
            set_lane(&mut self.states, lane, &start);
            self.lanes[lane] = Some(passage);
            if !self.finish_step(lane) {
                return;
            }
        }
    }

    /// Returns true if the simulation in a lane ends at the state that it has reached; false for an
    /// empty lane.
    fn finish_step(&mut self, lane: usize) -> bool {
        let Some(passage) = &mut self.lanes[lane] else { return false };
        let mut state = lane_of(&self.states, lane);
        // Readings are evaluated in the workspace of a single ship, with this simulation's
        // coefficients.
        if self.ship.reads_instruments() {
            self.own.set_coefficients(0, passage.coefficients());
        }
        let next = passage.next_step(self.ship, &mut state, &mut self.own);
        set_lane(&mut self.states, lane, &state);
        self.steps_s[lane] = next.unwrap_or_default();
        next.is_none()
    }
}

fn lane_rates<P: SimulationTask, const N: usize>(
    ship: &Ship,
    lanes: &[Option<&mut P>; N],
    stage: StepStage,
    states: &LaneStates<N>,
    work: &mut PlantWorkspace<N>,
) -> LaneStates<N> {
    let mut inputs = [[0.0; N]; MAX_INPUTS];
    let mut rudder = [0.0; N];
    for (lane, passage) in lanes.iter().enumerate() {
        // Inputs of a lane without a simulation stay zero; its result is not used.
        let (Some(passage), angle) = (passage, states[at::DELTA][lane]) else { continue };
        let own = passage.stage_inputs(ship, stage, angle);
        inputs
            .iter_mut()
            .zip(own)
            .take(ship.input_count())
            .for_each(|(lanes, value)| lanes[lane] = value);
        rudder[lane] = passage.rudder_rate(ship, angle);
    }
    let mut rates = ship.state_rates(states, &inputs, work);
    // The tape does not compute the rudder: its rate is that of the steering gear or the record.
    rates[at::DELTA] = rudder;
    rates
}
