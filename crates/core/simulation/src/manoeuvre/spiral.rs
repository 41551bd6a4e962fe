//! The direct spiral (Dieudonné 1953) and the reverse spiral (Bech 1966).

use super::ManoeuvreSettings;
use super::steady::{SteadyDetector, steady_settings};
use crate::envelope::SimulationStop;
use crate::metrics::{SpiralMetrics, SpiralPoint};
use crate::ship::{HelmOrder, Ship};
use crate::state::{StateVector, Trajectory, at, straight_state};

/// Rudder angles of the direct spiral from starboard amidships, deg, and the same to port:
/// MSC/Circ.1053, appendix 4, 2.1.6, with single degrees near amidships, where loops are.
const STEPS_DEG: [f64; 8] = [15.0, 10.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.0];
/// Yaw rates of the reverse spiral to each side of none, shares of the greatest: close together
/// where loops are.
const RATE_SHARES: [f64; 10] = [0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.55, 0.75, 1.0];
/// Longest time at one rudder angle or rate, in units of length over speed.
const MAX_LENGTHS: f64 = 100.0;

/// Simulates the direct and the reverse spiral.
///
/// # Errors
/// Returns an error with time and reason if the motion left the physical range.
pub fn simulate_spirals(
    ship: &Ship,
    settings: &ManoeuvreSettings,
) -> Result<SpiralMetrics, SimulationStop> {
    // From starboard to port and back; each end is visited once.
    let port = STEPS_DEG.iter().rev().skip(1).map(|angle| -angle);
    let there: Vec<f64> = STEPS_DEG.into_iter().chain(port).collect();
    let back = there.iter().rev().skip(1);
    let orders: Vec<f64> = there.iter().chain(back).copied().collect();
    let direct =
        simulate_orders(ship, settings, &orders, |rudder_deg, _: &StateVector| rudder_deg)?;
    // The reverse spiral covers the range of yaw rates of the direct one.
    let most = direct.iter().map(|point| point.rate_deg_s.abs()).fold(0.0, f64::max);
    let below = RATE_SHARES.iter().rev().map(|share| -share);
    let rates: Vec<f64> = below.chain([0.0]).chain(RATE_SHARES).map(|share| share * most).collect();
    let mut helm = YawRateController::new(ship, settings);
    let reverse =
        simulate_orders(ship, settings, &rates, |rate, state| helm.rudder_deg(rate, state))?;
    let length_s = ship.lpp_m() / settings.approach_speed(ship);
    Ok(SpiralMetrics::from_points(direct, reverse, length_s))
}

/// Simulates one order after the other, each until the motion is steady; `rudder_deg` returns the
/// rudder angle that carries out an order.
fn simulate_orders(
    ship: &Ship,
    settings: &ManoeuvreSettings,
    orders: &[f64],
    mut rudder_deg: impl FnMut(f64, &StateVector) -> f64,
) -> Result<Vec<SpiralPoint>, SimulationStop> {
    let (approach, engine) = (settings.approach_speed(ship), settings.engine_order(ship));
    let most_s = settings.duration_s.unwrap_or(MAX_LENGTHS * ship.lpp_m() / approach);
    let whole = steady_settings(settings, ship, most_s * orders.len() as f64);
    let mut steady = SteadyDetector::new(ship, approach, whole.step_length_s(ship));
    let (mut points, mut since_s) = (Vec::new(), 0.0);
    let run = whole.run_settings(ship, straight_state(approach));
    ship.simulate_orders(run, &mut Trajectory::default(), |t_s, state| {
        let is_steady = steady.is_steady(state);
        // A motion that does not become steady in the allowed time is recorded as it is.
        if is_steady || t_s - since_s >= most_s {
            points.push(spiral_point(state, is_steady));
            steady.clear_history();
            since_s = t_s;
        }
        // After the last order there is none, which ends the run.
        let order = orders.get(points.len())?;
        let delta_rad = rudder_deg(*order, state).to_radians();
        Some(HelmOrder { delta_rad, n_rps: engine.revolutions(state) })
    })?;
    Ok(points)
}

fn spiral_point(state: &StateVector, steady: bool) -> SpiralPoint {
    SpiralPoint {
        rudder_deg: state[at::DELTA].to_degrees(),
        rate_deg_s: state[at::R].to_degrees(),
        steady,
    }
}

/// Proportional-integral controller that holds a yaw rate by the rudder.
struct YawRateController {
    /// Length over speed, s: the unit of time of the gains.
    length_s: f64,
    step_s: f64,
    limit_deg: f64,
    /// Integral of the rate error, deg.
    missed_deg: f64,
}

/// Proportional gain, rudder angle per yaw rate in units of length over speed: above the 1/K' of
/// unstable ships, so that it alone stabilises them.
const PROPORTIONAL_GAIN: f64 = 4.0;
/// Integral gain, in the same units.
const INTEGRAL_GAIN: f64 = 1.0;

impl YawRateController {
    fn new(ship: &Ship, settings: &ManoeuvreSettings) -> Self {
        Self {
            length_s: ship.lpp_m() / settings.approach_speed(ship),
            step_s: steady_settings(settings, ship, 0.0).step_length_s(ship),
            limit_deg: ship.steering_gear().limit_rad().to_degrees(),
            missed_deg: 0.0,
        }
    }

    fn rudder_deg(&mut self, rate_deg_s: f64, state: &StateVector) -> f64 {
        let missing_deg = self.length_s * (rate_deg_s - state[at::R].to_degrees());
        let summed = self.missed_deg + INTEGRAL_GAIN * missing_deg * self.step_s / self.length_s;
        // Anti-windup: the integral is limited to the rudder's range.
        self.missed_deg = summed.clamp(-self.limit_deg, self.limit_deg);
        PROPORTIONAL_GAIN * missing_deg + self.missed_deg
    }
}
