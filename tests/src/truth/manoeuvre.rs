//! What the ships are told to do, and the figures of it.

use std::collections::BTreeMap;

use rand::RngExt;
use sistership_simulation::metrics::{TurningMetrics, ZigzagMetrics};
use sistership_simulation::state::{StateVector, Trajectory, at, straight_state};

use super::motion::{STEP_S, Truth, sail, sail_from};
use crate::synthetic::replica;

/// A manoeuvre by ordered rudder angles, deg, positive to starboard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Manoeuvre {
    /// Rudder and change of heading at which it is reversed.
    Zigzag(f64, f64),
    /// Rudder.
    Turn(f64),
    /// Rudder of a turn that ends with the rudder amidships.
    PullOut(f64),
    /// Orders at random of at most so much, each held for one to five ship lengths, and a seed.
    Random(f64, u64),
}

/// Lengths sailed before the first order.
pub(super) const APPROACH: f64 = 0.5;

impl Manoeuvre {
    /// A name for files.
    pub fn name(&self) -> String {
        match self {
            Self::Zigzag(rudder, switch) => format!("zigzag_{rudder}_{switch}"),
            Self::Turn(rudder) => format!("turn_{rudder}"),
            Self::PullOut(rudder) => format!("pull_out_{rudder}"),
            Self::Random(rudder, seed) => format!("random_{rudder}_{seed}"),
        }
    }

    /// How long it takes, by the time in which the ship sails its length.
    pub fn lengths(&self) -> f64 {
        match self {
            Self::Zigzag(..) => 25.0,
            Self::Turn(_) => 18.0,
            Self::PullOut(_) => 22.0,
            Self::Random(..) => 30.0,
        }
    }

    /// Sails it: one sample a step, without noise, at constant revolutions.
    pub fn sailed(&self, ship: &dyn Truth) -> Trajectory {
        let time_s = ship.dimensions().length_time_s();
        let approach = Approach { speed: 1.0, lengths: APPROACH };
        self.sailed_for(ship, approach, self.lengths() * time_s)
    }

    /// Sails it for so long (s) after an approach.
    pub fn sailed_for(&self, ship: &dyn Truth, approach: Approach, duration_s: f64) -> Trajectory {
        let time_s = ship.dimensions().length_time_s() / approach.speed;
        let before_s = approach.lengths * time_s;
        let mut helm = Helm::new(*self, time_s);
        let order =
            |t_s: f64, state: &StateVector| helm.order_deg(t_s - before_s, state).to_radians();
        let start = straight_state(approach.speed * ship.dimensions().speed_m_s);
        let n_rps = approach.speed * ship.revolutions_rps();
        sail_from(ship, start, before_s + duration_s, n_rps, order)
    }
}

/// How a manoeuvre is approached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Speed by the ship's own, with revolutions in proportion.
    pub speed: f64,
    /// Lengths sailed before the first order.
    pub lengths: f64,
}

/// Who steers.
pub(super) struct Helm {
    manoeuvre: Manoeuvre,
    length_time_s: f64,
    pub(super) reversals_s: Vec<f64>,
    orders: Vec<(f64, f64)>,
}

impl Helm {
    pub(super) fn new(manoeuvre: Manoeuvre, length_time_s: f64) -> Self {
        let orders = match manoeuvre {
            Manoeuvre::Random(rudder_deg, seed) => random_orders(rudder_deg, seed),
            _ => Vec::new(),
        };
        Self { manoeuvre, length_time_s, reversals_s: Vec::new(), orders }
    }

    /// The order, deg, so long after the first; headings count from that of the approach.
    pub(super) fn order_deg(&mut self, t_s: f64, state: &StateVector) -> f64 {
        if t_s < -1e-9 {
            return 0.0;
        }
        let lengths = t_s / self.length_time_s;
        match self.manoeuvre {
            Manoeuvre::Turn(rudder) => rudder,
            Manoeuvre::PullOut(rudder) => {
                if lengths < 9.0 {
                    rudder
                } else {
                    0.0
                }
            }
            Manoeuvre::Random(..) => {
                let now = self.orders.iter().take_while(|(from, _)| *from <= lengths).last();
                now.map_or(0.0, |(_, order)| *order)
            }
            Manoeuvre::Zigzag(rudder, switch) => self.zigzag_deg(t_s, rudder, switch, state),
        }
    }

    fn zigzag_deg(&mut self, t_s: f64, rudder: f64, switch: f64, state: &StateVector) -> f64 {
        let side = |reversals: usize| if reversals.is_multiple_of(2) { 1.0 } else { -1.0 };
        let turned = rudder.signum() * side(self.reversals_s.len()) * state[at::PSI].to_degrees();
        if turned >= switch {
            self.reversals_s.push(t_s);
        }
        side(self.reversals_s.len()) * rudder
    }
}

/// From when on (lengths) which order (deg) is held.
fn random_orders(rudder_deg: f64, seed: u64) -> Vec<(f64, f64)> {
    let mut rng = replica(seed, 77);
    let mut from = 0.0;
    let mut orders = Vec::new();
    while from < 40.0 {
        orders.push((from, rng.random_range(-rudder_deg..rudder_deg)));
        from += rng.random_range(1.0..5.0);
    }
    orders
}

/// The rudder angles, deg, of the turns whose figures are compared, and of the zigzags with their
/// change of heading.
const TURNS: [f64; 2] = [35.0, -35.0];
const ZIGZAGS: [(f64, f64); 4] = [(10.0, 10.0), (-10.0, 10.0), (20.0, 20.0), (-20.0, 20.0)];

/// Tactical diameter, advance (m) and overshoots (deg) by the names that `sistership manoeuvre`
/// gives them; absent where the ship did not get so far.
pub fn figures(ship: &dyn Truth) -> BTreeMap<String, f64> {
    let mut all = every_figure(ship);
    all.retain(|name, _| !name.ends_with(": transfer") && !name.ends_with(": period"));
    all
}

/// As [`figures`], with transfer (m) and the zigzags' periods (s).
pub fn every_figure(ship: &dyn Truth) -> BTreeMap<String, f64> {
    list_figures(|rudder| turning(ship, rudder), |rudder, switch| zigzag(ship, rudder, switch))
}

/// Figures of turns by their angle (deg) and of zigzags by theirs and the change of heading (deg).
pub(super) fn list_figures(
    turning: impl Fn(f64) -> TurningMetrics,
    zigzag: impl Fn(f64, f64) -> ZigzagMetrics,
) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    for rudder in TURNS {
        let metrics = turning(rudder);
        let of = |what: &str| format!("turn {rudder} deg: {what}");
        all.extend(metrics.advance_m.map(|value| (of("advance"), value)));
        all.extend(metrics.transfer_m.map(|value| (of("transfer"), value)));
        all.extend(metrics.tactical_diameter_m.map(|value| (of("tactical diameter"), value)));
    }
    for (rudder, switch) in ZIGZAGS {
        let metrics = zigzag(rudder, switch);
        let of = |what: &str| format!("zigzag {rudder}/{switch}: {what}");
        all.extend(metrics.first_overshoot_deg.map(|value| (of("first overshoot"), value)));
        all.extend(metrics.second_overshoot_deg.map(|value| (of("second overshoot"), value)));
        all.extend(metrics.period_s.map(|value| (of("period"), value)));
    }
    all
}

fn turning(ship: &dyn Truth, rudder_deg: f64) -> TurningMetrics {
    let duration_s = 18.0 * ship.dimensions().length_time_s();
    let order = |_: f64, _: &StateVector| rudder_deg.to_radians();
    let track = sail(ship, duration_s, ship.revolutions_rps(), order);
    TurningMetrics::from_track(&track, rudder_deg).expect("a track")
}

fn zigzag(ship: &dyn Truth, rudder_deg: f64, switch_deg: f64) -> ZigzagMetrics {
    let time_s = ship.dimensions().length_time_s();
    let mut helm = Helm::new(Manoeuvre::Zigzag(rudder_deg, switch_deg), time_s);
    let order = |t_s: f64, state: &StateVector| helm.order_deg(t_s, state).to_radians();
    let track = sail(ship, 40.0 * time_s, ship.revolutions_rps(), order);
    let reversals_s: Vec<f64> = helm.reversals_s.iter().map(|t_s| snapped(*t_s)).collect();
    ZigzagMetrics::from_track(&track, rudder_deg, switch_deg, &reversals_s).expect("a track")
}

/// The time of a sample.
fn snapped(t_s: f64) -> f64 {
    (t_s / STEP_S).round() * STEP_S
}

/// The trials of a learning curve, in the order in which they are added: first what a yard sails
/// first.
pub const PROGRAMME: [Manoeuvre; 12] = [
    Manoeuvre::Zigzag(20.0, 20.0),
    Manoeuvre::Turn(35.0),
    Manoeuvre::Zigzag(-10.0, 10.0),
    Manoeuvre::Turn(-35.0),
    Manoeuvre::Zigzag(10.0, 10.0),
    Manoeuvre::PullOut(20.0),
    Manoeuvre::Zigzag(-20.0, 20.0),
    Manoeuvre::Random(25.0, 1),
    Manoeuvre::Turn(20.0),
    Manoeuvre::Random(35.0, 2),
    Manoeuvre::PullOut(-20.0),
    Manoeuvre::Turn(-15.0),
];

/// Manoeuvres that no call sees: other angles than any of the programme, and other random orders.
pub const UNSEEN: [Manoeuvre; 6] = [
    Manoeuvre::Zigzag(15.0, 15.0),
    Manoeuvre::Zigzag(-15.0, 10.0),
    Manoeuvre::Turn(28.0),
    Manoeuvre::Turn(-25.0),
    Manoeuvre::PullOut(-30.0),
    Manoeuvre::Random(30.0, 3),
];
