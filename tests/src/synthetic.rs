//! Trials of ships whose coefficients are known: gusts drive them, and instruments scatter.

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_standard_manoeuvres};
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector, at, straight_state};
use sistership_simulation::{HelmOrder, Method, Ship, Trajectory};

/// What a ship is told to do.
#[derive(Debug, Clone, Copy)]
pub enum Orders {
    /// Rudder and change of heading, deg.
    Zigzag(f64, f64),
    /// Rudder, deg.
    Turn(f64),
}

/// How large gusts and errors are; by the ship's own size, so that every ship has the same trouble.
#[derive(Debug, Clone, Copy)]
pub struct Trouble {
    /// Standard deviation of the accelerations by gusts, by `U^2/L` and, of yaw, `U^2/L^2`.
    pub gusts: f64,
    /// Their correlation time, by `L/U`.
    pub gust_time: f64,
    /// Standard deviation of measured velocities, by `U` and, of yaw, `U/L`; of positions, by `L`.
    pub scatter: f64,
    /// Standard deviation of measured angles, deg.
    pub angles_deg: f64,
}

impl Default for Trouble {
    /// Gusts that move a ship of 160 m at 15 knots by some centimetres a second, and instruments
    /// that err as much.
    fn default() -> Self {
        Self { gusts: 0.003, gust_time: 0.5, scatter: 0.005, angles_deg: 0.1 }
    }
}

/// A trial of so many times `L/U`, twenty samples to each.
///
/// # Panics
/// The ship leaves the physical range.
pub fn trial(
    ship: &Ship,
    name: &str,
    orders: Orders,
    lengths: f64,
    trouble: &Trouble,
    rng: &mut ChaCha12Rng,
) -> Trial {
    let time_s = ship.lpp_m() / ship.approach_speed_m_s();
    let step_s = time_s / 100.0;
    let mut pilot = Pilot { orders, reversals: 0 };
    let (mut state, mut track) = (straight_state(ship.approach_speed_m_s()), Trajectory::default());
    let mut gusts = [0.0; 3].map(|_: f64| rng.sample::<f64, _>(StandardNormal));
    let n_rps = ship.revolutions_at(ship.approach_speed_m_s());
    let kept = (-step_s / (trouble.gust_time * time_s)).exp();
    let mut work = sistership_simulation::plant::PlantWorkspace::default();
    for k in 0..=(100.0 * lengths) as usize {
        if k.is_multiple_of(5) {
            track.push(k as f64 * step_s, state, n_rps);
        }
        ship.envelope()
            .check_state(k as f64 * step_s, &state)
            .unwrap_or_else(|stopped| panic!("{name}: {stopped}"));
        let order = HelmOrder { delta_rad: pilot.order_deg(&state).to_radians(), n_rps };
        let pushed = push(ship, &gusts, trouble);
        state = Method::Rk4.advance_state(&state, step_s, |_, s| {
            ship.rate_under(s, order, step_s, &mut work) + pushed
        });
        gusts = gusts.map(|gust| {
            kept * gust + (1.0 - kept * kept).sqrt() * rng.sample::<f64, _>(StandardNormal)
        });
    }
    measured(ship, name, &track, trouble, rng)
}

/// Accelerations by gusts.
fn push(ship: &Ship, gusts: &[f64; 3], trouble: &Trouble) -> StateVector {
    let (length, speed) = (ship.lpp_m(), ship.approach_speed_m_s());
    let unit = trouble.gusts * speed * speed / length;
    let mut rate = StateVector::zeros();
    for (place, (gust, unit)) in
        [at::U, at::V, at::R].into_iter().zip(gusts.iter().zip([unit, unit, unit / length]))
    {
        rate[place] = gust * unit;
    }
    rate
}

/// What instruments make of a track.
fn measured(
    ship: &Ship,
    name: &str,
    track: &Trajectory,
    trouble: &Trouble,
    rng: &mut ChaCha12Rng,
) -> Trial {
    let (length, speed) = (ship.lpp_m(), ship.approach_speed_m_s());
    let deviation = |channel: Channel| match channel {
        Channel::U | Channel::V => trouble.scatter * speed,
        Channel::R => trouble.scatter * speed / length,
        Channel::X | Channel::Y => trouble.scatter * length,
        _ => trouble.angles_deg.to_radians(),
    };
    let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
    let mut channels = std::collections::BTreeMap::new();
    for &(channel, place) in columns {
        let noisy = |value: f64| value + deviation(channel) * rng.sample::<f64, _>(StandardNormal);
        channels.insert(channel, track.state_column(place).into_iter().map(noisy).collect());
    }
    channels.insert(Channel::N, track.n_rps.clone());
    Trial { name: name.to_owned(), t_s: track.t_s.clone(), channels, ..Trial::default() }
}

struct Pilot {
    orders: Orders,
    reversals: usize,
}

impl Pilot {
    fn order_deg(&mut self, state: &StateVector) -> f64 {
        let Orders::Zigzag(rudder_deg, switch_deg) = self.orders else {
            let Orders::Turn(rudder_deg) = self.orders else { return 0.0 };
            return rudder_deg;
        };
        let side = |reversals: usize| {
            rudder_deg.signum() * if reversals.is_multiple_of(2) { 1.0 } else { -1.0 }
        };
        if side(self.reversals) * state[at::PSI].to_degrees() >= switch_deg {
            self.reversals += 1;
        }
        side(self.reversals) * rudder_deg.abs()
    }
}

/// A ship like another: every coefficient times a normal number of mean 1, so drawn that it sails
/// the standard manoeuvres.
pub fn relative(model: &Model, law: &Law, deviation: f64, rng: &mut ChaCha12Rng) -> Model {
    loop {
        let mut other = model.clone();
        other
            .coefficients
            .values_mut()
            .for_each(|q| q.value *= 1.0 + deviation * rng.sample::<f64, _>(StandardNormal));
        let settings = ManoeuvreSettings::default();
        let Ok(ship) = Ship::new(&other, law) else { continue };
        let sailed = simulate_standard_manoeuvres(&ship, &settings);
        let turned = sailed.turns.len() == 2
            && sailed.turns.iter().all(|turn| turn.tactical_diameter_m.is_some());
        if sailed.failures.is_empty() && turned {
            return other;
        }
    }
}

/// A random number of its own for each replica, so that replicas may run in any order.
pub fn replica(seed: u64, index: usize) -> ChaCha12Rng {
    let mut rng = <ChaCha12Rng as rand::SeedableRng>::seed_from_u64(seed);
    rng.set_stream(index as u64);
    rng
}
