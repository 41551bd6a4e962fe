//! Simulation of a session, with the draws of the posterior in parallel.

use sistership_model::environment::UncoveredInput;
use sistership_simulation::integrate::Method;
use sistership_simulation::plant::{Inputs, Work};
use sistership_simulation::state::at;
use sistership_simulation::{Order, Ship, SideBySide, StateVector, Stopped};

use super::request::{OrdersRequest, StepsRequest};
use super::sample::{Sample, band};
use crate::predictions::error::{PredictError, Result};
use crate::predictions::track::bounded;

/// Inputs of a law that have separate fields in a request.
const NAMED: [&str; 3] = ["delta", "n", "depth"];

/// Simulation that is continued step by step.
#[derive(Debug)]
pub struct Session {
    pub(super) ship: Ship,
    pub(super) beside: Option<Beside>,
    pub(super) state: StateVector,
    pub(super) order: Order,
    /// Wind, current and depth that the model's trials do not cover.
    pub(super) uncovered: Vec<UncoveredInput>,
    /// Other inputs of the law, by index.
    pub(super) others: Vec<(usize, f64)>,
    pub(super) t_s: f64,
    /// Longest step of the integration, s.
    pub(super) longest_s: f64,
    pub(super) stopped: Option<Stopped>,
    pub(super) work: Work,
}

/// Draws of the posterior, simulated under the same orders.
#[derive(Debug)]
pub(super) struct Beside {
    pub ship: Ship,
    pub sisters: SideBySide,
    /// Number of draws at the start.
    pub drawn: usize,
}

impl Session {
    /// Applies orders, all or none of them, in a request of at most `most` steps.
    ///
    /// # Errors
    /// Returns an error that names the invalid field of the request, or the missing memory.
    pub fn take(&mut self, request: &StepsRequest, most: usize) -> Result<()> {
        self.bounded(request.dt_s.get(), request.count(), most)?;
        // Everything that can fail comes before the first change of the session.
        let others = self.places(&request.orders)?;
        self.order(request.orders.delta_rad, request.orders.n_rps);
        for (place, value) in others {
            // A new order of an input replaces the previous one.
            self.others.retain(|(known, _)| *known != place);
            self.others.push((place, value));
        }
        Ok(())
    }

    /// Reserves the memory of steps; refuses more work than is allowed.
    pub(crate) fn bounded(&self, dt_s: f64, steps: usize, most: usize) -> Result<()> {
        // Draws are simulated in SIMD blocks, each of which costs about as much as one simulation.
        let blocks = self.beside.as_ref().map_or(0, |beside| beside.sisters.blocks());
        bounded("steps", (self.parts(dt_s) * steps) as f64 * (1 + blocks) as f64, most)
    }

    /// Sets the orders of rudder and revolutions; those not given stay.
    pub(crate) fn order(&mut self, delta_rad: Option<f64>, n_rps: Option<f64>) {
        delta_rad.into_iter().for_each(|delta_rad| self.order.delta_rad = delta_rad);
        n_rps.into_iter().for_each(|n_rps| self.order.n_rps = n_rps);
    }

    /// Simulates a step; `None` if the motion has left the physical range, in this step or before.
    pub fn step(&mut self, dt_s: f64) -> Option<Sample> {
        let parts = self.parts(dt_s);
        let (since_s, step_s) = (self.t_s, dt_s / parts as f64);
        for part in 1..=parts {
            // Times are multiples of the step, not sums, so that rounding errors do not accumulate.
            let t_s = since_s + part as f64 * step_s;
            if let Err(stopped) = self.part(t_s, step_s) {
                self.stopped = Some(stopped);
                return None;
            }
        }
        Some(self.sample())
    }

    /// Returns the present state with its band.
    pub(crate) fn sample(&self) -> Sample {
        let band = self.beside.as_ref().and_then(|beside| band(beside.sisters.states().collect()));
        Sample { t_s: self.t_s, state: self.state, n_rps: self.order.n_rps, band }
    }

    fn part(&mut self, t_s: f64, step_s: f64) -> std::result::Result<(), Stopped> {
        // A session that has stopped stays stopped.
        if let Some(stopped) = &self.stopped {
            return Err(stopped.clone());
        }
        let Self { ship, order, others, work, .. } = self;
        let next = Method::Rk4.step(&self.state, step_s, |_, state| {
            let inputs = inputs(ship, state[at::DELTA], order.n_rps, others);
            let mut rate = ship.rate_with(state, &inputs, work);
            // The rudder is a state: it follows the order at the rate of the steering gear.
            rate[at::DELTA] = ship.gear().rate(order.delta_rad, state[at::DELTA], step_s);
            rate
        });
        ship.envelope().check(t_s, &next)?;
        (self.state, self.t_s) = (next, t_s);
        if let Some(Beside { ship, sisters, .. }) = &mut self.beside {
            // Each draw fills in its own rudder angle.
            let inputs = inputs(ship, 0.0, self.order.n_rps, &self.others);
            sisters.step(ship, &inputs, self.order.delta_rad, step_s);
        }
        Ok(())
    }

    /// Number of parts in which a step is integrated.
    fn parts(&self, dt_s: f64) -> usize {
        (dt_s / self.longest_s).ceil().max(1.0) as usize
    }

    /// Returns the indices of other inputs with their values.
    fn places(&self, orders: &OrdersRequest) -> Result<Vec<(usize, f64)>> {
        let known: Vec<&str> = self.ship.law_inputs().map(|(name, _)| name).collect();
        let place = |(name, value): (&String, &f64)| {
            let place = known.iter().position(|known| known == name);
            match place.filter(|_| !NAMED.contains(&name.as_str())) {
                Some(place) => Ok((place, *value)),
                None => Err(unknown(name, &known)),
            }
        };
        orders.inputs.iter().map(place).collect()
    }
}

fn unknown(name: &str, known: &[&str]) -> PredictError {
    let others: Vec<&str> = known.iter().copied().filter(|name| !NAMED.contains(name)).collect();
    let message = match others.as_slice() {
        [] => "is no input of the law, which takes rudder and revolutions alone".to_owned(),
        others => format!("is no input of the law; others than those are {}", others.join(", ")),
    };
    PredictError::invalid(&format!("orders.inputs.{name}"), message)
}

fn inputs(ship: &Ship, delta_rad: f64, n_rps: f64, others: &[(usize, f64)]) -> Inputs {
    let mut inputs = ship.inputs(delta_rad, n_rps);
    others.iter().for_each(|&(place, value)| inputs[place] = value);
    inputs
}
