//! Runs under orders to rudder and engine, several in lockstep.

use crate::envelope::SimulationStop;
use crate::integrate::{Method, StepStage};
use crate::lockstep::{self, SimulationTask};
use crate::plant::{LawInputs, PlantWorkspace};
use crate::ship::{HelmOrder, RunSettings, Ship};
use crate::state::{StateVector, Trajectory};

/// Order and its duration: at most to the end of the step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HeldOrder {
    pub order: HelmOrder,
    pub lasts_s: f64,
}

/// Run to be simulated; `bridge` returns the order at each step, which is held during it, or `None`
/// to end the run. A step in which the order ends early is simulated in two parts.
pub(crate) struct OrderedRun<'a, B> {
    run: RunSettings,
    coefficients: &'a [f64],
    bridge: B,
    held: HeldOrder,
    step: usize,
    /// Part of the step that has been simulated, s.
    within_s: f64,
    sailed: RunOutcome,
}

/// Track of a run, and the reason of an early stop, if any.
#[derive(Debug, Default)]
pub(crate) struct RunOutcome {
    pub track: Trajectory,
    pub stopped: Option<SimulationStop>,
}

impl<'a, B: FnMut(f64, &StateVector) -> Option<HeldOrder>> OrderedRun<'a, B> {
    /// Creates a run; `coefficients` are the open coefficients, empty for a ship without any.
    pub fn new(run: RunSettings, coefficients: &'a [f64], bridge: B) -> Self {
        // The first call of the bridge replaces this order before any step.
        let held =
            HeldOrder { order: HelmOrder { delta_rad: 0.0, n_rps: 0.0 }, lasts_s: run.step_s };
        let sailed = RunOutcome::default();
        Self { run, coefficients, bridge, held, step: 0, within_s: 0.0, sailed }
    }
}

impl Ship {
    /// Simulates a run; `bridge` returns the order at each step, which is held during it, or `None`
    /// to end the run.
    ///
    /// # Errors
    /// Returns an error with time and reason if the motion left the physical range; `track` then
    /// holds the motion until that time.
    pub fn simulate_orders(
        &self,
        run: RunSettings,
        track: &mut Trajectory,
        mut bridge: impl FnMut(f64, &StateVector) -> Option<HelmOrder>,
    ) -> Result<(), SimulationStop> {
        // Every order is held for a whole step.
        let held = |t_s: f64, state: &StateVector| {
            Some(HeldOrder { order: bridge(t_s, state)?, lasts_s: run.step_s })
        };
        let sailed =
            simulate_runs(self, run.method, vec![OrderedRun::new(run, &[], held)]).remove(0);
        track.append(sailed.track);
        sailed.stopped.map_or(Ok(()), Err)
    }
}

/// Simulates runs in lockstep.
pub(crate) fn simulate_runs<'a, B>(
    ship: &Ship,
    method: Method,
    mut sailings: Vec<OrderedRun<'a, B>>,
) -> Vec<RunOutcome>
where
    B: FnMut(f64, &StateVector) -> Option<HeldOrder>,
{
    lockstep::run_batch(ship, method, &mut sailings);
    sailings.into_iter().map(|sailing| sailing.sailed).collect()
}

impl<B: FnMut(f64, &StateVector) -> Option<HeldOrder>> SimulationTask for OrderedRun<'_, B> {
    fn coefficients(&self) -> &[f64] {
        self.coefficients
    }

    fn initial_state(&mut self, _: &Ship, _: &mut PlantWorkspace) -> StateVector {
        self.run.start
    }

    fn next_step(
        &mut self,
        ship: &Ship,
        state: &mut StateVector,
        _: &mut PlantWorkspace,
    ) -> Option<f64> {
        let t_s = self.step as f64 * self.run.step_s + self.within_s;
        if let Err(stopped) = ship.envelope().check_state(t_s, state) {
            self.sailed.stopped = Some(stopped);
            return None;
        }
        self.held = (self.bridge)(t_s, state)?;
        // The track has the states at whole steps only, not those within a divided step.
        if self.within_s == 0.0 {
            self.sailed.track.push(t_s, *state, self.held.order.n_rps);
        }
        let left_s = self.run.step_s - self.within_s;
        // The order ends within the step: the rest of the step follows under the next order.
        if self.held.lasts_s < left_s {
            self.within_s += self.held.lasts_s;
            return Some(self.held.lasts_s);
        }
        // The order lasts to the end of the step.
        (self.held.lasts_s, self.within_s) = (left_s, 0.0);
        // The duration is rounded to a whole number of steps.
        let last = (self.run.duration_s / self.run.step_s).round() as usize;
        self.step += 1;
        (self.step <= last).then_some(left_s)
    }

    fn stage_inputs(&self, ship: &Ship, _: StepStage, rudder_rad: f64) -> LawInputs {
        ship.inputs_for(rudder_rad, self.held.order.n_rps)
    }

    fn rudder_rate(&self, ship: &Ship, rudder_rad: f64) -> f64 {
        ship.rudder_rate(self.held.order.delta_rad, rudder_rad, self.held.lasts_s)
    }
}
