//! Checks of a ship with its propeller stopped or reversed, straight ahead and from a turn.

use sistership_simulation::Ship;
use sistership_simulation::envelope::SimulationStop;
use sistership_simulation::integrate::Method;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::ship::{HelmOrder, RunSettings};
use sistership_simulation::state::{StateVector, Trajectory, at, straight_state};

use crate::thresholds::CHECK;

/// The error type for a check that is not passed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PropulsionFault {
    /// The law takes no revolutions, or those of the approach are not known.
    #[error("has no propeller revolutions as input")]
    NoRevolutions,
    /// The ship does not slow down as a body in water does.
    #[error(
        "with the propeller stopped, the relative change of speed within one ship length is \
         {rate:.2}; it should be between -{fastest} and -{slowest:.3}"
    )]
    Deceleration {
        /// Rate by `L/U`, dimensionless.
        rate: f64,
        /// Bounds.
        fastest: f64,
        /// Bounds.
        slowest: f64,
    },
    /// The ship speeds up where it should slow down.
    #[error("{motion}: accelerates again, to {share:.2} times the approach speed")]
    Rises {
        /// Order.
        motion: &'static str,
        /// Speed relative to that of the approach.
        share: f64,
    },
    /// The ship has not reached the end of the check after a time.
    #[error("{motion}: still at {share:.2} times the approach speed after {t_s:.0} s")]
    Late {
        /// Order.
        motion: &'static str,
        /// Speed relative to that of the approach.
        share: f64,
        /// Duration, s.
        t_s: f64,
    },
    /// The ship left the physical range.
    #[error("{motion}: {stopped}")]
    Stopped {
        /// Order.
        motion: &'static str,
        /// Time and reason.
        stopped: SimulationStop,
    },
}

/// An order, and the speed at which its check ends.
struct PropellerOrder {
    name: &'static str,
    /// Speed at the beginning, and revolutions, relative to those of the approach.
    start: f64,
    revolutions: f64,
    /// True if it begins in a turn.
    turning: bool,
    /// Returns true if a speed ends the check, given with the speed that counts as rest, both
    /// relative to that of the approach.
    arrived: fn(f64, f64) -> bool,
}

const STRAIGHT: [PropellerOrder; 4] = [
    PropellerOrder {
        name: "propeller stopped",
        start: 1.0,
        revolutions: 0.0,
        turning: false,
        arrived: |u, rest| u < rest,
    },
    PropellerOrder {
        name: "propeller reversed",
        start: 1.0,
        revolutions: -1.0,
        turning: false,
        arrived: |u, _| u < -CHECK.rest,
    },
    PropellerOrder {
        name: "astern from rest",
        start: 0.0,
        revolutions: -1.0,
        turning: false,
        arrived: |u, _| u < -CHECK.rest,
    },
    PropellerOrder {
        name: "ahead from rest",
        start: 0.0,
        revolutions: 1.0,
        turning: false,
        arrived: |u, _| u > CHECK.ahead[0],
    },
];

const TURNING: [PropellerOrder; 2] = [
    PropellerOrder {
        name: "propeller stopped in a turn",
        start: 1.0,
        revolutions: 0.0,
        turning: true,
        arrived: |u, rest| u < rest,
    },
    PropellerOrder {
        name: "propeller reversed in a turn",
        start: 1.0,
        revolutions: -1.0,
        turning: true,
        arrived: |u, _| u < 0.0,
    },
];

/// Checks that a ship comes to rest with the propeller stopped, stops and goes astern with it
/// reversed, and accelerates from rest, all straight ahead.
///
/// # Errors
/// Returns the fault of the first order that ends otherwise.
pub fn check_straight(ship: &Ship) -> Result<(), PropulsionFault> {
    check_motions(ship, &STRAIGHT)
}

/// Checks that a ship comes to rest and stops out of a turn as well.
///
/// # Errors
/// Returns the fault of the first order that ends otherwise.
pub fn check_turning(ship: &Ship) -> Result<(), PropulsionFault> {
    check_motions(ship, &TURNING)
}

fn check_motions(ship: &Ship, motions: &[PropellerOrder]) -> Result<(), PropulsionFault> {
    let speed = ship.approach_speed_m_s();
    if !ship.follows_revolutions() || ship.revolutions_at(speed) <= 0.0 {
        return Err(PropulsionFault::NoRevolutions);
    }
    // The ship's own deceleration sets the time scale of all orders.
    let longest_s = CHECK.patience * stopping_time_s(ship)?;
    motions.iter().try_for_each(|motion| simulate_order(ship, motion, longest_s))
}

/// The speed divided by the deceleration with the propeller stopped, s; an error if that is
/// implausible.
fn stopping_time_s(ship: &Ship) -> Result<f64, PropulsionFault> {
    let speed = ship.approach_speed_m_s();
    let surge =
        ship.rate_at(&straight_state(speed), 0.0, 0.0, &mut PlantWorkspace::default())[at::U];
    let length_s = ship.lpp_m() / speed;
    // Relative deceleration in the time of a ship length, dimensionless.
    let rate = surge / speed * length_s;
    let [least, most] = CHECK.stopping;
    let (fastest, slowest) = (1.0 / least, 1.0 / most);
    if (-fastest..=-slowest).contains(&rate) {
        return Ok(length_s / -rate);
    }
    Err(PropulsionFault::Deceleration { rate, fastest, slowest })
}

/// Speeds of a motion so far.
struct SpeedMonitor {
    /// Speed that counts as rest, relative to that of the approach.
    rest: f64,
    /// Least speed so far.
    least: f64,
    /// Last speed.
    last: f64,
    rises: bool,
    arrived: bool,
}

/// Simulates one order, after a turn if it has one, until the ship arrives, speeds up or takes too
/// long.
fn simulate_order(
    ship: &Ship,
    motion: &PropellerOrder,
    longest_s: f64,
) -> Result<(), PropulsionFault> {
    let name = motion.name;
    let (speed, length_s) = (ship.approach_speed_m_s(), ship.lpp_m() / ship.approach_speed_m_s());
    let turn_s = if motion.turning { CHECK.turn * length_s } else { 0.0 };
    let ahead_rps = ship.revolutions_at(speed);
    let run = RunSettings {
        start: straight_state(motion.start * speed),
        duration_s: turn_s + longest_s,
        step_s: CHECK.step * length_s,
        method: Method::Rk4,
    };
    let turn = HelmOrder { delta_rad: CHECK.turn_deg.to_radians(), n_rps: ahead_rps };
    let ordered = HelmOrder { delta_rad: 0.0, n_rps: motion.revolutions * ahead_rps };
    // A ship that begins far slower than its trials went must still lose half of its speed.
    let rest = (CHECK.rest * ship.greatest_speed_m_s() / speed).min(CHECK.rest_most);
    let (least, last) = (f64::INFINITY, motion.start);
    let mut watch = SpeedMonitor { rest, least, last, rises: false, arrived: false };
    let order = |t_s: f64, state: &StateVector| {
        if t_s < turn_s {
            return Some(turn);
        }
        // The watch begins only after the turn; `None` ends the simulation.
        watch.observe_speed(state[at::U] / speed, motion);
        (!watch.rises && !watch.arrived).then_some(ordered)
    };
    let went = ship.simulate_orders(run, &mut Trajectory::default(), order);
    went.map_err(|stopped| PropulsionFault::Stopped { motion: name, stopped })?;
    // A rise counts first, also if the ship arrived in the same step.
    match (watch.rises, watch.arrived) {
        (true, _) => Err(PropulsionFault::Rises { motion: name, share: watch.last }),
        (_, true) => Ok(()),
        _ => Err(PropulsionFault::Late { motion: name, share: watch.last, t_s: longest_s }),
    }
}

impl SpeedMonitor {
    /// Records a speed. Out of a turn a ship may gain speed at first.
    fn observe_speed(&mut self, share: f64, motion: &PropellerOrder) {
        let should_fall = motion.revolutions <= 0.0 && !motion.turning;
        let too_fast = share > CHECK.ahead[1];
        // A small rise is tolerated, as of a decaying drift.
        self.rises = too_fast || should_fall && share > self.least + CHECK.rise;
        (self.least, self.last) = (self.least.min(share), share);
        self.arrived = (motion.arrived)(share, self.rest);
    }
}
