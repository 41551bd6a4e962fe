//! How the true ship sails: its bridge, its rudder, and what is hidden in either.

use sistership_model::effect::{AppliedEffect, TIME_INPUT};
use sistership_model::quantity::Quantity;
use sistership_model::{Law, Model};
use sistership_simulation::gear::SteeringGear;
use sistership_simulation::plant::{LawInputs, PlantWorkspace};
use sistership_simulation::state::{StateVector, at, straight_state};
use sistership_simulation::{Ship, Trajectory};

use super::{Hidden, Unlisted, Weather, ZOO, published};

/// Step, s.
pub const STEP_S: f64 = 0.1;
/// How long every trial is recorded, s.
pub const DURATION_S: f64 = 650.0;
/// Revolutions of all trials, 1/s.
pub const N_RPS: f64 = 100.0 / 60.0;

/// What the bridge does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Manoeuvre {
    /// A turning circle with a rudder angle, deg.
    Turn(f64),
    /// A zigzag with a rudder angle, of which the sign is that of the first execution, and a change
    /// of heading, deg.
    Zigzag(f64, f64),
}

/// One trial of a programme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sailing {
    pub manoeuvre: Manoeuvre,
    pub heading_deg: f64,
    /// When the rudder is first executed, s.
    pub execute_s: f64,
}

/// The true ship.
pub struct TrueShip {
    ship: Ship,
    /// From half time on, where the propeller fails.
    later: Option<Ship>,
    gear: SteeringGear,
    lag_s: Option<f64>,
    /// Steady speed through the water, m/s.
    approach_m_s: f64,
    /// Velocity of the water to the north and to the east, m/s.
    current_m_s: (f64, f64),
    pub delay_s: f64,
    pub wind: Option<Weather>,
    pub has_wind_sensor: bool,
    unlisted: Option<Unlisted>,
}

/// The state, its velocities through the water, and the angle of the rudder itself where it lags
/// behind the one that is recorded.
#[derive(Debug, Clone, Copy)]
struct Motion {
    state: StateVector,
    rudder_rad: f64,
}

impl Motion {
    fn plus(self, rate: Self, time_s: f64) -> Self {
        Self {
            state: self.state + rate.state * time_s,
            rudder_rad: self.rudder_rad + rate.rudder_rad * time_s,
        }
    }
}

fn parameter(effects: &[AppliedEffect], effect: &str, name: &str) -> Option<f64> {
    effects.iter().find(|known| known.name == effect).map(|known| known.parameters[name].value)
}

impl TrueShip {
    pub fn new(hidden: &Hidden) -> Self {
        let mut model = published();
        let law = ZOO.law(&model.law).unwrap();
        let of = |effect: &str, name: &str| parameter(&hidden.effects, effect, name);
        // What is true beyond the first order is done by this ship itself.
        let own = |effect: &&AppliedEffect| {
            ["current", "rudder-lag", "time-delay"].contains(&effect.name.as_str())
        };
        model.effects = hidden.effects.iter().filter(|effect| !own(effect)).cloned().collect();
        let ship = Ship::new(&model, law).unwrap_or_else(|error| panic!("{error}"));
        Self {
            later: failing(&model, law, hidden.unlisted),
            gear: SteeringGear::new(&model.steering),
            lag_s: of("rudder-lag", "time_constant_s"),
            approach_m_s: N_RPS / ship.revolutions_at(1.0),
            current_m_s: of("current", "north_m_s")
                .zip(of("current", "east_m_s"))
                .unwrap_or_default(),
            delay_s: of("time-delay", "delay_s").unwrap_or(0.0),
            wind: hidden.wind,
            has_wind_sensor: !hidden.no_wind_sensor,
            unlisted: hidden.unlisted,
            ship,
        }
    }

    /// Sails a trial; `wind_m_s` is the speed of the wind at each step, empty where it is calm.
    pub fn sail(&self, sailing: &Sailing, wind_m_s: &[f64]) -> Trajectory {
        let mut motion =
            Motion { state: self.start(sailing.heading_deg.to_radians()), rudder_rad: 0.0 };
        let (mut track, mut work) = (Trajectory::default(), PlantWorkspace::default());
        let mut bridge = sailing.bridge();
        for k in 0..=(DURATION_S / STEP_S).round() as usize {
            let t_s = k as f64 * STEP_S;
            self.ship
                .envelope()
                .check_state(t_s, &motion.state)
                .unwrap_or_else(|stopped| panic!("the true ship {stopped}"));
            track.push(t_s, self.over_ground(&motion.state), N_RPS);
            let order_rad = bridge(t_s, &motion.state);
            motion = self.step(t_s, motion, order_rad, wind_m_s.get(k).copied(), &mut work);
        }
        track
    }

    /// What the instruments would say of a sample without noise and delay.
    pub fn says(
        &self,
        t_s: f64,
        state: &StateVector,
        wind_m_s: Option<f64>,
        work: &mut PlantWorkspace,
    ) -> StateVector {
        let inputs = self.inputs(t_s, state[at::DELTA], wind_m_s);
        self.ship.instrument_readings(
            sistership_model::manifest::VelocityFrame::Ground,
            state,
            &inputs,
            work,
        )
    }

    /// Steady through the water.
    fn start(&self, heading_rad: f64) -> StateVector {
        let mut state = straight_state(self.approach_m_s);
        state[at::PSI] = heading_rad;
        state
    }

    /// The same motion with velocities over the ground. In moving water it sails as in still water
    /// and is carried along; the library adds the current to a law in the ship's axes, which is the
    /// same but for the cosine of the roll.
    fn over_ground(&self, state: &StateVector) -> StateVector {
        let ((sin, cos), (north, east)) = (state[at::PSI].sin_cos(), self.current_m_s);
        let mut state = *state;
        state[at::U] += north * cos + east * sin;
        state[at::V] += east * cos - north * sin;
        state
    }

    fn inputs(&self, t_s: f64, rudder_rad: f64, wind_m_s: Option<f64>) -> LawInputs {
        let mut inputs = self.ship.inputs_for(rudder_rad, N_RPS);
        let wind = self.wind_over_water(wind_m_s.unwrap_or(0.0));
        for (value, (name, _)) in inputs.iter_mut().zip(self.ship.law_inputs()) {
            match name {
                TIME_INPUT => *value = t_s,
                "wind_speed" => *value = wind.0.hypot(wind.1),
                "wind_from" => *value = wind.1.atan2(wind.0),
                _ => {}
            }
        }
        inputs
    }

    /// The wind that blows over the water, as components of where it comes from: that over the
    /// ground, and the current's own.
    fn wind_over_water(&self, speed_m_s: f64) -> (f64, f64) {
        let (sin, cos) = self.wind.map_or(0.0, |wind| wind.from_rad).sin_cos();
        (speed_m_s * cos + self.current_m_s.0, speed_m_s * sin + self.current_m_s.1)
    }

    fn step(
        &self,
        t_s: f64,
        motion: Motion,
        order_rad: f64,
        wind_m_s: Option<f64>,
        work: &mut PlantWorkspace,
    ) -> Motion {
        let mut rate = |fraction: f64, m: Motion| {
            self.rate(t_s + fraction * STEP_S, m, order_rad, wind_m_s, work)
        };
        let k1 = rate(0.0, motion);
        let k2 = rate(0.5, motion.plus(k1, 0.5 * STEP_S));
        let k3 = rate(0.5, motion.plus(k2, 0.5 * STEP_S));
        let k4 = rate(1.0, motion.plus(k3, STEP_S));
        [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)]
            .into_iter()
            .fold(motion, |sum, (k, w)| sum.plus(k, w * STEP_S / 6.0))
    }

    fn rate(
        &self,
        t_s: f64,
        motion: Motion,
        order_rad: f64,
        wind_m_s: Option<f64>,
        work: &mut PlantWorkspace,
    ) -> Motion {
        let state = &motion.state;
        let rudder_rad = if self.lag_s.is_some() { motion.rudder_rad } else { state[at::DELTA] };
        let ship = self.later.as_ref().filter(|_| t_s >= 0.5 * DURATION_S).unwrap_or(&self.ship);
        let mut rate = ship.rate_with(state, &self.inputs(t_s, rudder_rad, wind_m_s), work);
        rate[at::X] += self.current_m_s.0;
        rate[at::Y] += self.current_m_s.1;
        rate[at::DELTA] = self.gear.rudder_rate(order_rad, state[at::DELTA], STEP_S);
        match self.unlisted {
            Some(Unlisted::OscillatingMoment { amplitude_rad_s2 }) => {
                rate[at::R] += amplitude_rad_s2 * (std::f64::consts::TAU * t_s / 60.0).sin();
            }
            Some(Unlisted::HeadingForce { amplitude_m_s2 }) => {
                rate[at::V] += amplitude_m_s2 * (3.0 * state[at::PSI]).cos()
            }
            Some(Unlisted::ThrustLoss { .. }) | None => {}
        }
        let lag = self.lag_s.map_or(0.0, |lag_s| (state[at::DELTA] - motion.rudder_rad) / lag_s);
        Motion { state: rate, rudder_rad: lag }
    }
}

/// The ship after the propeller has failed: the thrust deduction takes the share that is lost.
fn failing(model: &Model, law: &Law, unlisted: Option<Unlisted>) -> Option<Ship> {
    let Some(Unlisted::ThrustLoss { share }) = unlisted else { return None };
    let mut model = model.clone();
    let left = (1.0 - share) * (1.0 - model.parameters["t"].value);
    model.parameters.insert("t".into(), Quantity::new(1.0 - left, "the truth"));
    Some(Ship::new(&model, law).unwrap_or_else(|error| panic!("{error}")))
}

impl Sailing {
    /// What people call it.
    pub fn name(&self) -> String {
        match self.manoeuvre {
            Manoeuvre::Turn(rudder) => format!("turn {rudder:+} at {:03}", self.heading_deg),
            Manoeuvre::Zigzag(rudder, switch) => {
                format!("zigzag {rudder}/{switch} at {:03}", self.heading_deg)
            }
        }
    }

    /// The rudder that the bridge orders on the true heading, rad.
    fn bridge(&self) -> impl FnMut(f64, &StateVector) -> f64 + use<> {
        let Self { manoeuvre, heading_deg, execute_s } = *self;
        let mut side = 1.0;
        move |t_s, state| {
            if t_s < execute_s - 1e-9 {
                return 0.0;
            }
            match manoeuvre {
                Manoeuvre::Turn(rudder_deg) => rudder_deg.to_radians(),
                Manoeuvre::Zigzag(rudder_deg, switch_deg) => {
                    let turned_deg = state[at::PSI].to_degrees() - heading_deg;
                    if side * rudder_deg.signum() * turned_deg >= switch_deg {
                        side = -side;
                    }
                    side * rudder_deg.to_radians()
                }
            }
        }
    }
}
