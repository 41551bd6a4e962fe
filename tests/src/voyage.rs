//! A voyage: course keeping by an autopilot in waves and gusts, and manoeuvres at known times.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Write};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use sistership_model::trial::Channel;
use sistership_model::{Trial, Zoo};
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector, at, straight_state};
use sistership_simulation::{HelmOrder as Helm, Method, Ship};

const SPEED_M_S: f64 = 10.47;
/// Steps of the simulation, s.
const STEP_S: f64 = 0.5;
/// Standard deviations of instruments: velocities, yaw and roll rate, angles, positions.
const NOISE: [f64; 9] = [3e-3, 3e-3, 5e-5, 2e-4, 5e-4, 5e-4, 0.3, 0.3, 5e-4];
/// Yaw acceleration by waves, rad/s2, and its frequency, rad/s.
const WAVES: (f64, f64) = (1.5e-3, 0.75);
/// Standard deviation of the accelerations by gusts, m/s2, and of yaw, rad/s2; how long they last,
/// s.
const GUSTS: ([f64; 3], f64) = ([2e-3, 2e-3, 1e-5], 30.0);

/// Angles in deg, times in s.
#[derive(Debug, Clone, Copy)]
pub enum Order {
    /// Rudder and change of heading; four reversals.
    Zigzag(f64, f64),
    /// Rudder, and for how long.
    Turn(f64, f64),
    /// Rudder for so long, then amidships for a third of it, until the ship keeps straight.
    PullOut(f64, f64),
}

impl fmt::Display for Order {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.pad(&match self {
            Self::Zigzag(rudder, switch) => format!("zigzag {rudder}/{switch}"),
            Self::Turn(rudder, for_s) => format!("turn {rudder}, {for_s} s"),
            Self::PullOut(rudder, for_s) => format!("pull-out {rudder}, {for_s} s"),
        })
    }
}

/// What is to be sailed.
pub struct Voyage {
    rows: usize,
    /// Rows to a step of the simulation.
    each: usize,
    plan: Vec<(f64, Order)>,
    is_calm: bool,
    seed: u64,
}

/// What was sailed.
pub struct Sailed {
    /// The rows.
    pub trial: Trial,
    /// Each manoeuvre, and from when to when.
    pub manoeuvres: Vec<(Order, f64, f64)>,
}

impl Voyage {
    /// Manoeuvres at equal distances in a log, with so many rows to half a second.
    pub fn long(rows: usize, each: usize, orders: &[Order]) -> Self {
        let apart_s = rows as f64 * STEP_S / each as f64 / orders.len() as f64;
        // None begins at a multiple of the time by which the log is cut.
        let start = |k: usize| (apart_s * (0.4 + k as f64) + 137.0 * k as f64).floor();
        let plan = orders.iter().enumerate().map(|(k, &order)| (start(k), order)).collect();
        Self { rows, each, plan, is_calm: false, seed: 1 }
    }

    /// One manoeuvre by itself, after a minute's approach.
    pub fn short(each: usize, order: Order, seed: u64) -> Self {
        Self {
            rows: 1_800 * each,
            each,
            plan: vec![(60.0, order)],
            is_calm: true,
            seed: 100 + seed,
        }
    }

    /// Sails it.
    ///
    /// # Panics
    /// The zoo does not have the ship.
    pub fn sail(self) -> Sailed {
        let zoo = Zoo::load_embedded().expect("the zoo");
        let model = zoo.find_model("sr108").expect("a model");
        let law = zoo.law(&model.law).expect("its law");
        let ship = Ship::new(&model, law).expect("a ship");
        let mut log = Log::new(self.rows, self.each, self.seed);
        let mut pilot =
            Pilot { plan: self.plan, next: 0, under: None, course: 0.0, done: Vec::new() };
        let mut sea = Sea::new(self.is_calm, self.seed);
        let n_rps = ship.revolutions_at(SPEED_M_S);
        let (mut state, mut work) = (straight_state(SPEED_M_S), PlantWorkspace::default());
        for step in 0..self.rows / self.each {
            let t_s = step as f64 * STEP_S;
            let order = Helm { delta_rad: pilot.helm(t_s, &state), n_rps };
            let push = sea.push(t_s);
            let after = Method::Rk4.advance_state(&state, STEP_S, |_, s| {
                ship.rate_under(s, order, STEP_S, &mut work) + push
            });
            log.interpolate(t_s, &state, &after, n_rps);
            state = after;
        }
        Sailed { trial: log.trial(), manoeuvres: pilot.done }
    }
}

/// Accelerations by waves and gusts.
struct Sea {
    rng: ChaCha12Rng,
    gusts: [f64; 3],
    is_calm: bool,
}

impl Sea {
    fn new(is_calm: bool, seed: u64) -> Self {
        Self { rng: ChaCha12Rng::seed_from_u64(1000 + seed), gusts: [0.0; 3], is_calm }
    }

    fn push(&mut self, t_s: f64) -> StateVector {
        let mut rate = StateVector::zeros();
        if self.is_calm {
            return rate;
        }
        let kept = (-STEP_S / GUSTS.1).exp();
        for (gust, place) in self.gusts.iter_mut().zip([at::U, at::V, at::R]) {
            let fresh = self.rng.sample::<f64, _>(StandardNormal);
            *gust = kept * *gust + (1.0 - kept * kept).sqrt() * fresh;
            rate[place] = *gust * GUSTS.0[place];
        }
        // Waves come in groups, and are higher on some days.
        let height = (1.0 + 0.6 * (t_s / 3.0e4).sin()) * (1.0 + 0.5 * (0.03 * t_s).sin());
        rate[at::R] += height * WAVES.0 * (WAVES.1 * t_s + (0.011 * t_s).sin()).cos();
        rate
    }
}

struct Pilot {
    plan: Vec<(f64, Order)>,
    next: usize,
    /// What is sailed, since when, from which heading, and reversals.
    under: Option<(Order, f64, f64, usize)>,
    course: f64,
    done: Vec<(Order, f64, f64)>,
}

impl Pilot {
    fn helm(&mut self, t_s: f64, state: &StateVector) -> f64 {
        if let Some(&(start_s, order)) = self.plan.get(self.next).filter(|(at, _)| *at <= t_s) {
            self.next += 1;
            self.under = Some((order, start_s, state[at::PSI], 0));
        }
        let Some((order, since_s, psi, reversals)) = self.under else { return self.keep(state) };
        let (rudder_deg, is_over) = match order {
            Order::Zigzag(rudder, switch) => {
                let side = if reversals % 2 == 0 { rudder } else { -rudder };
                let turned = (state[at::PSI] - psi).to_degrees() * side.signum();
                self.under = Some((order, since_s, psi, reversals + usize::from(turned >= switch)));
                (side, reversals >= 5)
            }
            Order::Turn(rudder, for_s) => (rudder, t_s - since_s > for_s),
            Order::PullOut(rudder, for_s) if t_s - since_s < for_s => (rudder, false),
            Order::PullOut(_, for_s) => (0.0, t_s - since_s > 4.0 / 3.0 * for_s),
        };
        if !is_over {
            return rudder_deg.to_radians();
        }
        self.under = None;
        self.done.push((order, since_s, t_s));
        self.course = if matches!(order, Order::Zigzag(..)) { psi } else { state[at::PSI] };
        self.keep(state)
    }

    fn keep(&self, state: &StateVector) -> f64 {
        let ordered = -(state[at::PSI] - self.course) - 12.0 * state[at::R];
        ordered.clamp(-0.35, 0.35)
    }
}

/// Rows with the noise of instruments.
struct Log {
    each: usize,
    rng: ChaCha12Rng,
    t_s: Vec<f64>,
    states: Vec<(Channel, usize, Vec<f64>)>,
    n_rps: Vec<f64>,
}

impl Log {
    fn new(rows: usize, each: usize, seed: u64) -> Self {
        let recorded = RECORDED_CHANNELS.iter().copied().chain([(Channel::Delta, at::DELTA)]);
        let states = recorded.map(|(channel, place)| (channel, place, Vec::with_capacity(rows)));
        let rng = ChaCha12Rng::seed_from_u64(seed);
        Self {
            each,
            rng,
            t_s: Vec::with_capacity(rows),
            states: states.collect(),
            n_rps: Vec::new(),
        }
    }

    fn interpolate(&mut self, t_s: f64, from: &StateVector, to: &StateVector, n_rps: f64) {
        for k in 0..self.each {
            let share = k as f64 / self.each as f64;
            self.t_s.push(t_s + share * STEP_S);
            for (_, place, values) in &mut self.states {
                let value = from[*place] + share * (to[*place] - from[*place]);
                values.push(value + NOISE[*place] * self.rng.sample::<f64, _>(StandardNormal));
            }
            self.n_rps.push(n_rps * (1.0 + 5e-3 * self.rng.sample::<f64, _>(StandardNormal)));
        }
    }

    fn trial(self) -> Trial {
        let states = self.states.into_iter().map(|(channel, _, values)| (channel, values));
        let mut channels: BTreeMap<Channel, Vec<f64>> = states.collect();
        channels.insert(Channel::N, self.n_rps);
        Trial { t_s: self.t_s, channels, ..Trial::default() }
    }
}

/// Columns as loggers have them: degrees, revolutions a minute, a heading from 0 to 360.
const COLUMNS: [(Channel, &str, f64, usize); 10] = [
    (Channel::U, "surge [m/s]", 1.0, 3),
    (Channel::V, "sway [m/s]", 1.0, 3),
    (Channel::R, "yaw rate [deg/s]", 57.295_779_513, 4),
    (Channel::Psi, "heading [deg]", 57.295_779_513, 2),
    (Channel::Delta, "rudder angle [deg]", 57.295_779_513, 2),
    (Channel::N, "propeller [rpm]", 60.0, 2),
    (Channel::X, "north [m]", 1.0, 1),
    (Channel::Y, "east [m]", 1.0, 1),
    (Channel::Phi, "roll [deg]", 57.295_779_513, 2),
    (Channel::P, "roll rate [deg/s]", 57.295_779_513, 3),
];

/// The log as a CSV file.
///
/// # Errors
/// It cannot be written.
pub fn write_csv(mut out: impl Write, trial: &Trial) -> io::Result<()> {
    let columns: Vec<&[f64]> =
        COLUMNS.iter().filter_map(|(channel, ..)| trial.channel(*channel)).collect();
    let names: Vec<&str> = COLUMNS.iter().map(|(_, name, ..)| *name).collect();
    writeln!(out, "time [s],{}", names.join(","))?;
    for (k, t_s) in trial.t_s.iter().enumerate() {
        write!(out, "{t_s:.1}")?;
        for (values, (channel, _, factor, digits)) in columns.iter().zip(COLUMNS) {
            let value = values[k] * factor;
            let value = if channel == Channel::Psi { value.rem_euclid(360.0) } else { value };
            write!(out, ",{value:.digits$}")?;
        }
        out.write_all(b"\n")?;
    }
    out.flush()
}
