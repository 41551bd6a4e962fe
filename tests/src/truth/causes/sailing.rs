//! Trials with something hidden.

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use sistership_model::Trial;
use sistership_model::trial::Channel;
use sistership_simulation::state::{StateVector, Trajectory, at, straight_state};

use super::super::foreign::motion::{Motion, SHAFTS};
use super::super::foreign::simulate::mean_rps;
use super::super::instruments::Instruments;
use super::super::manoeuvre::{APPROACH, Helm, Manoeuvre};
use super::super::motion::{Truth, rate_under};
use super::force::Moment;
use super::gear::Standing;
use super::hidden::Hidden;
use super::wind::Wind;

/// A manoeuvre on a heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// What is sailed.
    pub manoeuvre: Manoeuvre,
    /// Heading of the approach, deg.
    pub heading_deg: f64,
}

/// Scatter of an anemometer: of the speed by itself, and of the direction, rad.
const ANEMOMETER: [f64; 2] = [0.03, 0.05];

/// Trials that a ship sailed, as its instruments recorded them; each by a random number of its own.
pub fn trials(
    ship: &dyn Truth,
    hidden: &Hidden,
    courses: &[Course],
    instruments: &Instruments,
    seed: u64,
) -> Vec<Trial> {
    let one = |(index, course): (usize, &Course)| {
        let mut rng = crate::synthetic::replica(seed, 200 + index);
        let before = Hidden { wind: hidden.wind, current: hidden.current, ..Hidden::default() };
        let hidden = if index < hidden.first_trial { &before } else { hidden };
        let mut track = sailed(ship, hidden, course);
        let since_s = hidden.since * track.t_s.last().copied().unwrap_or(0.0);
        hidden.sensors.iter().for_each(|sensor| sensor.indicated(&mut track, since_s));
        let name = format!("{}_on_{}.csv", course.manoeuvre.name(), course.heading_deg);
        let mut trial = instruments.record(ship, &name, &track, &mut rng);
        if let Some(wind) = hidden.wind.filter(|wind| wind.is_recorded) {
            anemometer(&mut trial, &wind, &mut rng);
        }
        trial
    };
    courses.iter().enumerate().map(one).collect()
}

fn anemometer(trial: &mut Trial, wind: &Wind, rng: &mut ChaCha12Rng) {
    let mut scatter = || rng.sample::<f64, _>(StandardNormal);
    let count = trial.t_s.len();
    let speed = (0..count).map(|_| wind.speed_m_s * (1.0 + ANEMOMETER[0] * scatter())).collect();
    trial.channels.insert(Channel::WindSpeed, speed);
    let from = (0..count).map(|_| wind.from_rad + ANEMOMETER[1] * scatter()).collect();
    trial.channels.insert(Channel::WindFrom, from);
}

/// One sample a step; the rudder of the states is the one that is recorded.
fn sailed(ship: &dyn Truth, hidden: &Hidden, course: &Course) -> Trajectory {
    let time_s = ship.dimensions().length_time_s();
    let duration_s = (APPROACH + course.manoeuvre.lengths()) * time_s;
    let sea = Sea { ship, hidden, duration_s };
    let mut helm = Helm::new(course.manoeuvre, time_s);
    let mut gear: Vec<Standing> = hidden.gear.iter().map(|gear| Standing::new(*gear)).collect();
    let step_s = ship.step_s();
    let n_rps = [ship.revolutions_rps(); SHAFTS];
    let mut motion = Motion { body: sea.begun(course.heading_deg.to_radians()), n_rps };
    let mut track = Trajectory::default();
    for k in 0..=(duration_s / step_s).round() as usize {
        let (t_s, state) = (k as f64 * step_s, motion.body);
        track.push(t_s, state, mean_rps(&motion, SHAFTS));
        let mut seen = state;
        seen[at::PSI] -= course.heading_deg.to_radians();
        let order_rad = helm.order_deg(t_s - APPROACH * time_s, &seen).to_radians();
        let follow =
            |angle, standing: &mut Standing| standing.after(angle, t_s / duration_s, step_s);
        let is_there = t_s >= hidden.since * duration_s;
        let recorded_rad = state[at::DELTA];
        let actual_rad = match is_there {
            true => gear.iter_mut().fold(recorded_rad, follow),
            false => recorded_rad,
        };
        motion = sea.step(t_s, &motion, order_rad, actual_rad - recorded_rad);
    }
    track
}

/// A ship among what is hidden.
struct Sea<'a> {
    ship: &'a dyn Truth,
    hidden: &'a Hidden,
    duration_s: f64,
}

impl Sea<'_> {
    /// Straight running through the water at the approach speed.
    fn begun(&self, heading_rad: f64) -> StateVector {
        let mut state = straight_state(self.ship.dimensions().speed_m_s);
        state[at::PSI] = heading_rad;
        if let Some(current) = self.hidden.current {
            let [along, across] = current.seen(0.0, heading_rad);
            state[at::U] += along;
            state[at::V] += across;
        }
        state
    }

    /// What the gear adds to the recorded rudder stays within a step, not where the rudder is:
    /// held for a step it would follow by half a step late in trials without any gear.
    fn step(&self, t_s: f64, motion: &Motion, order_rad: f64, added_rad: f64) -> Motion {
        let step_s = self.ship.step_s();
        motion.runge_kutta_step(step_s, |fraction, now| {
            let t_s = t_s + fraction * step_s;
            let (accelerations, n_rps) = self.accelerations(t_s, now, added_rad);
            let body = rate_under(self.ship, &now.body, order_rad, accelerations);
            Motion { body, n_rps }
        })
    }

    /// Accelerations of the ship, and of its shafts.
    fn accelerations(
        &self,
        t_s: f64,
        motion: &Motion,
        added_rad: f64,
    ) -> ([f64; 4], [f64; SHAFTS]) {
        let state = &motion.body;
        let share = t_s / self.duration_s;
        let [along, across] =
            self.hidden.current.map_or([0.0; 2], |current| current.seen(share, state[at::PSI]));
        let mut relative = *state;
        relative[at::U] -= along;
        relative[at::V] -= across;
        relative[at::DELTA] += added_rad;
        let (mut all, shafts) = self.ship.powered_accelerations(&relative, motion.n_rps);
        let mut add = |more: &[f64]| all.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        if let Some(current) = self.hidden.current {
            add(&current.rates([along, across], state[at::R], self.duration_s));
        }
        if let Some(wind) = self.hidden.wind {
            add(&self.ship.inertia().answers(wind.forces(self.ship.dimensions(), state)));
        }
        let through_water = [at::U, at::V, at::R].map(|place| relative[place]);
        let now = Moment { t_s, share, state, through_water };
        let forces = self.hidden.forces.iter().filter(|_| share >= self.hidden.since);
        forces.for_each(|force| add(&force.accelerations(self.ship, &now)));
        (all, shafts)
    }
}
