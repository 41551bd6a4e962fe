//! Runs under orders from the bridge, several in lockstep.

use crate::envelope::Stopped;
use crate::integrate::{Method, Stage};
use crate::lockstep::{self, Passage};
use crate::plant::{Inputs, Work};
use crate::ship::{Order, Run, Ship};
use crate::state::{StateVector, Trajectory};

/// A run to be sailed; `bridge` gives the order at each step, which is held over it, or `None` to end the run.
pub(crate) struct Sailing<'a, B> {
    run: Run,
    coefficients: &'a [f64],
    bridge: B,
    order: Order,
    step: usize,
    sailed: Sailed,
}

/// What was sailed, and why it ended early if it did.
#[derive(Debug, Default)]
pub(crate) struct Sailed {
    pub track: Trajectory,
    pub stopped: Option<Stopped>,
}

impl<'a, B: FnMut(f64, &StateVector) -> Option<Order>> Sailing<'a, B> {
    /// `coefficients` are the ship's own among sisters, and none for a ship with hers.
    pub fn new(run: Run, coefficients: &'a [f64], bridge: B) -> Self {
        let order = Order { delta_rad: 0.0, n_rps: 0.0 };
        Self { run, coefficients, bridge, order, step: 0, sailed: Sailed::default() }
    }
}

impl Ship {
    /// Sails for a time; `bridge` gives the order at each step, which is held over it, or `None` to end the run.
    ///
    /// # Errors
    /// Says when and why the motion left the physical range; what was sailed until then is in `track`.
    pub fn sail(
        &self,
        run: Run,
        track: &mut Trajectory,
        bridge: impl FnMut(f64, &StateVector) -> Option<Order>,
    ) -> Result<(), Stopped> {
        let sailed = sail_all(self, run.method, vec![Sailing::new(run, &[], bridge)]).remove(0);
        track.append(sailed.track);
        sailed.stopped.map_or(Ok(()), Err)
    }
}

/// Sails runs in lockstep.
pub(crate) fn sail_all<'a, B>(
    ship: &Ship,
    method: Method,
    mut sailings: Vec<Sailing<'a, B>>,
) -> Vec<Sailed>
where
    B: FnMut(f64, &StateVector) -> Option<Order>,
{
    lockstep::sail(ship, method, &mut sailings);
    sailings.into_iter().map(|sailing| sailing.sailed).collect()
}

impl<B: FnMut(f64, &StateVector) -> Option<Order>> Passage for Sailing<'_, B> {
    fn coefficients(&self) -> &[f64] {
        self.coefficients
    }

    fn start(&mut self, _: &Ship, _: &mut Work) -> StateVector {
        self.run.start
    }

    fn arrive(&mut self, ship: &Ship, state: &mut StateVector, _: &mut Work) -> Option<f64> {
        let t_s = self.step as f64 * self.run.step_s;
        if let Err(stopped) = ship.envelope().check(t_s, state) {
            self.sailed.stopped = Some(stopped);
            return None;
        }
        self.order = (self.bridge)(t_s, state)?;
        self.sailed.track.push(t_s, *state, self.order.n_rps);
        let last = (self.run.duration_s / self.run.step_s).round() as usize;
        self.step += 1;
        (self.step <= last).then_some(self.run.step_s)
    }

    fn inputs(&self, ship: &Ship, _: Stage, rudder_rad: f64) -> Inputs {
        ship.inputs(rudder_rad, self.order.n_rps)
    }

    fn rudder_rate(&self, ship: &Ship, rudder_rad: f64) -> f64 {
        ship.rudder_rate(self.order.delta_rad, rudder_rad, self.run.step_s)
    }
}
