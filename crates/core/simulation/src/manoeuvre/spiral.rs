//! The direct spiral (Dieudonné 1953) and the reverse spiral (Bech 1966).

use super::ManoeuvreSettings;
use super::steady::{Steady, to_the_end};
use crate::envelope::Stopped;
use crate::metrics::{SpiralMetrics, SpiralPoint};
use crate::ship::{Order, Ship};
use crate::state::{StateVector, Trajectory, at, straight};

/// Rudder angles of the direct spiral from starboard amidships, deg, and the same to port:
/// MSC/Circ.1053, appendix 4, 2.1.6, with single degrees near amidships, where loops are.
const STEPS_DEG: [f64; 8] = [15.0, 10.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.0];
/// Yaw rates of the reverse spiral to each side of none, shares of the greatest: close together
/// where loops are.
const SHARES: [f64; 10] = [0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.55, 0.75, 1.0];
/// Longest time at one rudder angle or rate, in units of length over speed.
const MOST_LENGTHS: f64 = 100.0;

/// Simulates the direct and the reverse spiral.
///
/// # Errors
/// Returns an error with time and reason if the motion left the physical range.
pub fn spiral(ship: &Ship, settings: &ManoeuvreSettings) -> Result<SpiralMetrics, Stopped> {
    // From starboard to port and back; each end is visited once.
    let port = STEPS_DEG.iter().rev().skip(1).map(|angle| -angle);
    let there: Vec<f64> = STEPS_DEG.into_iter().chain(port).collect();
    let back = there.iter().rev().skip(1);
    let orders: Vec<f64> = there.iter().chain(back).copied().collect();
    let direct = sail(ship, settings, &orders, |rudder_deg, _: &StateVector| rudder_deg)?;
    // The reverse spiral covers the range of yaw rates of the direct one.
    let most = direct.iter().map(|point| point.rate_deg_s.abs()).fold(0.0, f64::max);
    let below = SHARES.iter().rev().map(|share| -share);
    let rates: Vec<f64> = below.chain([0.0]).chain(SHARES).map(|share| share * most).collect();
    let mut helm = RateHelm::new(ship, settings);
    let reverse = sail(ship, settings, &rates, |rate, state| helm.rudder_deg(rate, state))?;
    let length_s = ship.lpp_m() / settings.speed(ship);
    Ok(SpiralMetrics::of(direct, reverse, length_s))
}

/// Simulates one order after the other, each until the motion is steady; `rudder_deg` returns the
/// rudder angle that carries out an order.
fn sail(
    ship: &Ship,
    settings: &ManoeuvreSettings,
    orders: &[f64],
    mut rudder_deg: impl FnMut(f64, &StateVector) -> f64,
) -> Result<Vec<SpiralPoint>, Stopped> {
    let (approach, n_rps) = (settings.speed(ship), settings.revolutions(ship));
    let most_s = settings.duration_s.unwrap_or(MOST_LENGTHS * ship.lpp_m() / approach);
    let whole = to_the_end(settings, ship, most_s * orders.len() as f64);
    let mut steady = Steady::new(ship, approach, whole.step(ship));
    let (mut points, mut since_s) = (Vec::new(), 0.0);
    let run = whole.run(ship, straight(approach));
    ship.sail(run, &mut Trajectory::default(), |t_s, state| {
        let is_steady = steady.is_steady(state);
        // A motion that does not become steady in the allowed time is recorded as it is.
        if is_steady || t_s - since_s >= most_s {
            points.push(point(state, is_steady));
            steady.restart();
            since_s = t_s;
        }
        // After the last order there is none, which ends the run.
        let order = orders.get(points.len())?;
        Some(Order { delta_rad: rudder_deg(*order, state).to_radians(), n_rps })
    })?;
    Ok(points)
}

fn point(state: &StateVector, steady: bool) -> SpiralPoint {
    SpiralPoint {
        rudder_deg: state[at::DELTA].to_degrees(),
        rate_deg_s: state[at::R].to_degrees(),
        steady,
    }
}

/// Proportional-integral controller that holds a yaw rate by the rudder.
struct RateHelm {
    /// Length over speed, s: the unit of time of the gains.
    length_s: f64,
    step_s: f64,
    limit_deg: f64,
    /// Integral of the rate error, deg.
    missed_deg: f64,
}

/// Proportional gain, rudder angle per yaw rate in units of length over speed: above the 1/K' of
/// unstable ships, so that it alone stabilises them.
const BY_RATE: f64 = 4.0;
/// Integral gain, in the same units.
const BY_SUM: f64 = 1.0;

impl RateHelm {
    fn new(ship: &Ship, settings: &ManoeuvreSettings) -> Self {
        Self {
            length_s: ship.lpp_m() / settings.speed(ship),
            step_s: to_the_end(settings, ship, 0.0).step(ship),
            limit_deg: ship.gear().limit_rad().to_degrees(),
            missed_deg: 0.0,
        }
    }

    fn rudder_deg(&mut self, rate_deg_s: f64, state: &StateVector) -> f64 {
        let missing_deg = self.length_s * (rate_deg_s - state[at::R].to_degrees());
        let summed = self.missed_deg + BY_SUM * missing_deg * self.step_s / self.length_s;
        // Anti-windup: the integral is limited to the rudder's range.
        self.missed_deg = summed.clamp(-self.limit_deg, self.limit_deg);
        BY_RATE * missing_deg + self.missed_deg
    }
}
