//! Simulation of a session, with the draws of the posterior in parallel.

use sistership_model::environment::UncoveredInput;
use sistership_simulation::integrate::Method;
use sistership_simulation::plant::{LawInputs, PlantWorkspace};
use sistership_simulation::state::at;
use sistership_simulation::{HelmOrder, Ship, ShipEnsemble, SimulationStop, StateVector};

use super::request::{OrdersRequest, StepsRequest};
use super::sample::{SessionSample, quantile_band};
use crate::predictions::error::{PredictionError, Result};
use crate::predictions::track::reserve_steps;

/// Inputs of a law that have separate fields in a request.
const SEPARATE_INPUTS: [&str; 3] = ["delta", "n", "depth"];

/// Simulation that is continued step by step.
#[derive(Debug)]
pub struct PredictionSession {
    pub(super) ship: Ship,
    pub(super) beside: Option<PosteriorDraws>,
    pub(super) state: StateVector,
    pub(super) order: HelmOrder,
    /// Wind, current and depth that the model's trials do not cover.
    pub(super) uncovered: Vec<UncoveredInput>,
    /// Other inputs of the law, by index.
    pub(super) others: Vec<(usize, f64)>,
    pub(super) t_s: f64,
    /// Longest step of the integration, s.
    pub(super) longest_s: f64,
    pub(super) stopped: Option<SimulationStop>,
    pub(super) work: PlantWorkspace,
}

/// Draws of the posterior, simulated under the same orders.
#[derive(Debug)]
pub(super) struct PosteriorDraws {
    pub ship: Ship,
    pub sisters: ShipEnsemble,
    /// Number of draws at the start.
    pub drawn: usize,
}

impl PredictionSession {
    /// Applies orders, all or none of them, in a request of at most `most` steps.
    ///
    /// # Errors
    /// Returns an error that names the invalid field of the request, or the missing memory.
    pub fn apply_orders(&mut self, request: &StepsRequest, most: usize) -> Result<()> {
        let steps = self.integration_steps(request.dt_s.get(), request.step_count());
        reserve_steps("steps", steps, most)?;
        // Everything that can fail comes before the first change of the session.
        let others = self.input_indices(&request.orders)?;
        self.set_orders(request.orders.delta_rad, request.orders.n_rps);
        for (place, value) in others {
            // A new order of an input replaces the previous one.
            self.others.retain(|(known, _)| *known != place);
            self.others.push((place, value));
        }
        Ok(())
    }

    /// Number of steps of the integration in `steps` steps of the session, over all its models.
    pub(crate) fn integration_steps(&self, dt_s: f64, steps: usize) -> f64 {
        // Draws are simulated in SIMD blocks, each of which costs about as much as one simulation.
        let blocks = self.beside.as_ref().map_or(0, |beside| beside.sisters.block_count());
        (self.count_parts(dt_s) * steps) as f64 * (1 + blocks) as f64
    }

    /// Sets the orders of rudder and revolutions; those not given stay.
    pub(crate) fn set_orders(&mut self, delta_rad: Option<f64>, n_rps: Option<f64>) {
        delta_rad.into_iter().for_each(|delta_rad| self.order.delta_rad = delta_rad);
        n_rps.into_iter().for_each(|n_rps| self.order.n_rps = n_rps);
    }

    /// Simulates a step; `None` if the motion has left the physical range, in this step or before.
    pub fn simulate_step(&mut self, dt_s: f64) -> Option<SessionSample> {
        let parts = self.count_parts(dt_s);
        let (since_s, step_s) = (self.t_s, dt_s / parts as f64);
        for part in 1..=parts {
            // Times are multiples of the step, not sums, so that rounding errors do not accumulate.
            let t_s = since_s + part as f64 * step_s;
            if let Err(stopped) = self.integrate_part(t_s, step_s) {
                self.stopped = Some(stopped);
                return None;
            }
        }
        Some(self.current_sample())
    }

    /// Returns the present state with its band.
    pub(crate) fn current_sample(&self) -> SessionSample {
        let band = self
            .beside
            .as_ref()
            .and_then(|beside| quantile_band(beside.sisters.active_states().collect()));
        SessionSample { t_s: self.t_s, state: self.state, n_rps: self.order.n_rps, band }
    }

    fn integrate_part(&mut self, t_s: f64, step_s: f64) -> std::result::Result<(), SimulationStop> {
        // A session that has stopped stays stopped.
        if let Some(stopped) = &self.stopped {
            return Err(stopped.clone());
        }
        let Self { ship, order, others, work, .. } = self;
        let next = Method::Rk4.advance_state(&self.state, step_s, |_, state| {
            let inputs = inputs_with_orders(ship, state[at::DELTA], order.n_rps, others);
            let mut rate = ship.rate_with(state, &inputs, work);
            // The rudder is a state: it follows the order at the rate of the steering gear.
            rate[at::DELTA] =
                ship.steering_gear().rudder_rate(order.delta_rad, state[at::DELTA], step_s);
            rate
        });
        ship.envelope().check_state(t_s, &next)?;
        (self.state, self.t_s) = (next, t_s);
        if let Some(PosteriorDraws { ship, sisters, .. }) = &mut self.beside {
            // Each draw has its own helm angle.
            let (order, others) = (self.order, &self.others);
            let inputs = |delta_rad: f64| inputs_with_orders(ship, delta_rad, order.n_rps, others);
            sisters.advance_step(ship, &inputs, order, step_s);
        }
        Ok(())
    }

    /// Number of parts in which a step is integrated.
    fn count_parts(&self, dt_s: f64) -> usize {
        (dt_s / self.longest_s).ceil().max(1.0) as usize
    }

    /// Returns the indices of other inputs with their values.
    fn input_indices(&self, orders: &OrdersRequest) -> Result<Vec<(usize, f64)>> {
        let known: Vec<&str> = self.ship.law_inputs().map(|(name, _)| name).collect();
        let place = |(name, value): (&String, &f64)| {
            let place = known.iter().position(|known| known == name);
            match place.filter(|_| !SEPARATE_INPUTS.contains(&name.as_str())) {
                Some(place) => Ok((place, *value)),
                None => Err(unknown_input(name, &known)),
            }
        };
        orders.inputs.iter().map(place).collect()
    }
}

fn unknown_input(name: &str, known: &[&str]) -> PredictionError {
    let others: Vec<&str> =
        known.iter().copied().filter(|name| !SEPARATE_INPUTS.contains(name)).collect();
    let message = match others.as_slice() {
        [] => "is not an input of the law, whose only inputs are rudder and revolutions".to_owned(),
        others => format!("is not an input of the law; its other inputs are {}", others.join(", ")),
    };
    PredictionError::invalid_field(&format!("orders.inputs.{name}"), message)
}

fn inputs_with_orders(
    ship: &Ship,
    delta_rad: f64,
    n_rps: f64,
    others: &[(usize, f64)],
) -> LawInputs {
    let mut inputs = ship.inputs_for(delta_rad, n_rps);
    others.iter().for_each(|&(place, value)| inputs[place] = value);
    inputs
}
