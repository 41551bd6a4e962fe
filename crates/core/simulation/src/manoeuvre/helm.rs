//! Orders to the rudder during a manoeuvre, and the simulation of many manoeuvres at once.

use super::ManoeuvreSettings;
use super::engine::EngineOrder;
use crate::envelope::SimulationStop;
use crate::ordered_runs::{HeldOrder, OrderedRun, simulate_runs};
use crate::ship::{HelmOrder, Ship};
use crate::state::{StateVector, Trajectory, at, straight_state};

/// A manoeuvre by its angles, deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Manoeuvre {
    /// A turning circle.
    Turn {
        /// Rudder angle.
        rudder: f64,
    },
    /// A zigzag of four reversals.
    Zigzag {
        /// Rudder angle, to the side of the first execute.
        rudder: f64,
        /// Change of heading at which the rudder is reversed.
        switch: f64,
    },
}

impl std::fmt::Display for Manoeuvre {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Turn { rudder } => write!(out, "turn {rudder} deg"),
            Self::Zigzag { rudder, switch } => write!(out, "zigzag {rudder}/{switch}"),
        }
    }
}

/// Simulated manoeuvre.
#[derive(Debug)]
pub struct SimulatedManoeuvre {
    /// Track from the execution of the rudder on.
    pub after: Trajectory,
    /// Track including the approach before it.
    pub track: Trajectory,
    /// Times of the reversals of the rudder, s after its execution.
    pub reversals_s: Vec<f64>,
}

/// Simulates manoeuvres in lockstep, each by a ship with its own coefficients, in the order of the
/// ship's open coefficients ([`Ship::sister`]); these are empty for a ship without open
/// coefficients.
///
/// Each result is an error by itself if its motion leaves the physical range, with time and reason.
pub fn simulate_manoeuvre_batch(
    ship: &Ship,
    manoeuvres: &[(Manoeuvre, &[f64])],
    settings: &ManoeuvreSettings,
) -> Vec<Result<SimulatedManoeuvre, SimulationStop>> {
    // Every manoeuvre starts from straight running at the approach speed.
    let run = settings.run_settings(ship, straight_state(settings.approach_speed(ship)));
    let mut helms: Vec<ManoeuvreHelm> = manoeuvres
        .iter()
        .map(|(manoeuvre, _)| ManoeuvreHelm::new(ship, *manoeuvre, settings))
        .collect();
    let sailings = helms.iter_mut().zip(manoeuvres).map(|(helm, (_, coefficients))| {
        OrderedRun::new(run, coefficients, |t_s, state: &StateVector| helm.next_order(t_s, state))
    });
    let sailings = sailings.collect();
    let sailed = simulate_runs(ship, settings.method, sailings);
    let one =
        |(helm, sailed): (ManoeuvreHelm, crate::ordered_runs::RunOutcome)| match sailed.stopped {
            Some(stopped) => Err(stopped),
            None => {
                // The track includes the approach, the metrics start at the execution.
                let after = track_after(&sailed.track, settings.run_in_s);
                Ok(SimulatedManoeuvre { after, track: sailed.track, reversals_s: helm.reversals_s })
            }
        };
    helms.into_iter().zip(sailed).map(one).collect()
}

/// Rudder angle and change of heading of the initial turning test, deg.
pub(super) const INITIAL_DEG: f64 = 10.0;
/// Tolerance of the heading, deg: a hundredth of the resolution of overshoots.
const HEADING_TOLERANCE_DEG: f64 = 1e-3;
/// Smallest part of a step that is simulated separately: it ends the approach to a heading.
const SMALLEST_STEP_PART: f64 = 1e-3;

/// Controller that carries out a manoeuvre.
struct ManoeuvreHelm {
    manoeuvre: Manoeuvre,
    engine: EngineOrder,
    run_in_s: f64,
    /// True if the run continues after the manoeuvre is complete.
    goes_on: bool,
    /// True if the rudder is reversed at the heading, not at the end of the step.
    at_heading: bool,
    /// True if an initial turn ends soon after its heading.
    figures_only: bool,
    step_s: f64,
    reversals_s: Vec<f64>,
}

impl ManoeuvreHelm {
    fn new(ship: &Ship, manoeuvre: Manoeuvre, settings: &ManoeuvreSettings) -> Self {
        Self {
            manoeuvre,
            engine: settings.engine_order(ship),
            run_in_s: settings.run_in_s,
            goes_on: settings.duration_s.is_some(),
            at_heading: settings.reversals_within_steps,
            figures_only: settings.figures_only,
            step_s: settings.step_length_s(ship),
            reversals_s: Vec::new(),
        }
    }

    /// Returns the order at a time; `None` when the manoeuvre is complete.
    fn next_order(&mut self, t_s: f64, state: &StateVector) -> Option<HeldOrder> {
        let since_s = t_s - self.run_in_s;
        // The tolerance absorbs the rounding of the sum of steps.
        let rudder_deg = if since_s < -1e-9 { 0.0 } else { self.rudder_deg(since_s, state) };
        let n_rps = self.engine.revolutions(state);
        let order = HelmOrder { delta_rad: rudder_deg.to_radians(), n_rps };
        let held = HeldOrder { order, lasts_s: self.order_duration_s(state) };
        // A given duration continues the run after the manoeuvre is complete.
        (self.goes_on || !self.is_done(state)).then_some(held)
    }

    /// Rudder angle, deg. A zigzag reverses the rudder at the first step at which the heading has
    /// reached the switching angle.
    fn rudder_deg(&mut self, since_s: f64, state: &StateVector) -> f64 {
        let rudder = match self.manoeuvre {
            Manoeuvre::Turn { rudder } => return rudder,
            Manoeuvre::Zigzag { rudder, .. } => rudder,
        };
        let tolerance = if self.at_heading { HEADING_TOLERANCE_DEG } else { 0.0 };
        // A step that ends at the heading does so by extrapolation, hence the tolerance.
        if self.remaining_heading_deg(state).is_some_and(|(to_go, _)| to_go <= tolerance) {
            self.reversals_s.push(since_s);
        }
        self.rudder_side() * rudder
    }

    /// Side of the rudder: 1 before the first reversal, -1 before the second, and so on.
    fn rudder_side(&self) -> f64 {
        if self.reversals_s.len().is_multiple_of(2) { 1.0 } else { -1.0 }
    }

    /// Returns the remaining change of heading to the next switching angle, deg, and the rate at
    /// which it decreases, deg/s.
    fn remaining_heading_deg(&self, state: &StateVector) -> Option<(f64, f64)> {
        let Manoeuvre::Zigzag { rudder, switch } = self.manoeuvre else { return None };
        let side = self.rudder_side() * rudder.signum();
        let to_go = switch - side * state[at::PSI].to_degrees();
        Some((to_go, side * state[at::R].to_degrees()))
    }

    /// Duration of an order, s: to the heading at which the rudder is reversed, if that is reached
    /// within the step, otherwise the whole step.
    fn order_duration_s(&self, state: &StateVector) -> f64 {
        match self.remaining_heading_deg(state).filter(|_| self.at_heading) {
            // Linear extrapolation of the heading; the lower limit ensures progress.
            Some((to_go, rate)) if rate * self.step_s > to_go => {
                (to_go / rate).max(SMALLEST_STEP_PART * self.step_s)
            }
            _ => self.step_s,
        }
    }

    fn is_done(&self, state: &StateVector) -> bool {
        match self.manoeuvre {
            // The state at which a run ends is not kept: twice the heading is well past the change
            // of interest.
            Manoeuvre::Turn { rudder } if self.figures_only && rudder.abs() == INITIAL_DEG => {
                rudder.signum() * state[at::PSI] > 2.0 * INITIAL_DEG.to_radians()
            }
            Manoeuvre::Turn { .. } => state[at::PSI].abs() > 3.0 * std::f64::consts::TAU,
            // The fifth crossing ends the run, so that the overshoot after the fourth reversal is
            // complete.
            Manoeuvre::Zigzag { .. } => self.reversals_s.len() > 4,
        }
    }
}

/// Returns the part of a track from a time on, with time counted from there.
fn track_after(track: &Trajectory, from_s: f64) -> Trajectory {
    let keep = |index: &usize| track.t_s[*index] >= from_s - 1e-9;
    let mut result = Trajectory::default();
    for k in (0..track.t_s.len()).filter(keep) {
        result.push(track.t_s[k] - from_s, track.states[k], track.n_rps[k]);
    }
    result
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;

    use super::super::simulate_zigzag;
    use super::*;

    #[test]
    fn reversals_within_steps_make_coarse_steps_as_good_as_fine_ones() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let ship = Ship::new(&model, zoo.law(&model.law).unwrap()).unwrap();
        let overshoot = |step_s: f64, reversals_within_steps: bool| {
            let step_s = Some(step_s);
            let settings =
                ManoeuvreSettings { step_s, reversals_within_steps, ..Default::default() };
            simulate_zigzag(&ship, 20.0, 20.0, &settings)
                .unwrap()
                .metrics
                .first_overshoot_deg
                .unwrap()
        };
        let exact = overshoot(0.005, false);
        let error =
            |within: bool| [0.3, 0.4, 0.5].map(|step| (overshoot(step, within) - exact).abs());
        assert!(error(true).iter().all(|error| *error < 0.02), "{:?}", error(true));
        assert!(error(false).iter().any(|error| *error > 0.05), "{:?}", error(false));
    }
}
