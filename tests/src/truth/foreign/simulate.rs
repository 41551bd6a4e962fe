//! Simulation of a craft: manoeuvres by the helm, and runs with the propeller stopped or reversed.

use std::collections::BTreeMap;

use sistership_simulation::metrics::{TurningMetrics, ZigzagMetrics};
use sistership_simulation::state::{StateVector, Trajectory, at};

use super::craft::Craft;
use super::motion::{Motion, Orders, SHAFTS};
use crate::truth::manoeuvre::{Helm, Manoeuvre, list_figures};

/// Lengths covered before the first order.
const APPROACH: f64 = 1.0;
/// Lengths covered in the turns by which craft are judged.
const TURN_LENGTHS: f64 = 25.0;
/// Lengths covered in the zigzags.
const ZIGZAG_LENGTHS: f64 = 40.0;

/// States over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Track {
    /// Time, s, in equal steps.
    pub t_s: Vec<f64>,
    /// State at each time.
    pub motions: Vec<Motion>,
}

impl Track {
    /// Surge velocity over time, m/s.
    pub fn speeds(&self) -> Vec<f64> {
        self.motions.iter().map(|motion| motion.body[at::U]).collect()
    }

    /// The same with the mean of the shafts.
    pub fn trajectory(&self, shafts: usize) -> Trajectory {
        let mut all = Trajectory::default();
        for (t_s, motion) in self.t_s.iter().zip(&self.motions) {
            all.push(*t_s, motion.body, mean_rps(motion, shafts));
        }
        all
    }
}

/// Mean revolutions of the shafts, 1/s.
pub fn mean_rps(motion: &Motion, shafts: usize) -> f64 {
    motion.n_rps[..shafts].iter().sum::<f64>() / shafts as f64
}

/// A manoeuvre at a speed by that of the craft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// What is ordered.
    pub manoeuvre: Manoeuvre,
    /// Speed of the approach by that of the craft.
    pub speed: f64,
}

impl Run {
    /// A name for files.
    pub fn name(&self) -> String {
        format!("{}_at_{:.0}", self.manoeuvre.name(), 100.0 * self.speed)
    }

    /// Simulates it, one sample a step, without noise.
    pub fn simulate(&self, craft: &Craft) -> Track {
        let length_s = craft.size().length_time_s() / self.speed;
        let before_s = APPROACH * length_s;
        let mut helm = Helm::new(self.manoeuvre, length_s);
        let level = craft.orders(self.speed, 0.0).n_rps[0];
        let orders = |t_s: f64, motion: &Motion| {
            let angle_deg = helm.order_deg(t_s - before_s, &motion.body);
            craft.orders_at(level, angle_deg.to_radians())
        };
        let duration_s = before_s + self.manoeuvre.lengths() * length_s;
        simulate(craft, start(craft, self.speed), duration_s, orders)
    }
}

/// Straight running at a speed by that of the craft, with the revolutions that balance it.
pub fn start(craft: &Craft, speed: f64) -> Motion {
    let speed_m_s = speed * craft.size().speed_m_s;
    Motion::straight(speed_m_s, [craft.balanced_rps(speed_m_s); SHAFTS])
}

/// Simulates for a time under orders that may follow the state.
pub fn simulate(
    craft: &Craft,
    start: Motion,
    duration_s: f64,
    mut orders: impl FnMut(f64, &Motion) -> Orders,
) -> Track {
    let step = craft.step_s();
    let (mut track, mut motion) = (Track::default(), start);
    for k in 0..=(duration_s / step).round() as usize {
        let t_s = k as f64 * step;
        track.t_s.push(t_s);
        track.motions.push(motion);
        motion = advance(craft, &motion, &orders(t_s, &motion), step);
    }
    track
}

/// The state a step (s) later, by the Runge-Kutta method of fourth order.
pub fn advance(craft: &Craft, motion: &Motion, orders: &Orders, step: f64) -> Motion {
    motion.runge_kutta_step(step, |_, now| craft.rate(now, orders))
}

/// Turning circle from full speed with the angle ordered at once.
pub fn turning(craft: &Craft, angle_deg: f64) -> TurningMetrics {
    let duration_s = TURN_LENGTHS * craft.size().length_time_s();
    let orders = craft.orders(1.0, angle_deg.to_radians());
    let track = simulate(craft, start(craft, 1.0), duration_s, |_, _| orders);
    TurningMetrics::from_track(&track.trajectory(craft.shafts()), angle_deg).expect("a track")
}

/// Zigzag from full speed with the angle ordered at once.
fn zigzag(craft: &Craft, angle_deg: f64, switch_deg: f64) -> ZigzagMetrics {
    let length_s = craft.size().length_time_s();
    let mut helm = Helm::new(Manoeuvre::Zigzag(angle_deg, switch_deg), length_s);
    let level = craft.orders(1.0, 0.0).n_rps[0];
    let track = simulate(craft, start(craft, 1.0), ZIGZAG_LENGTHS * length_s, |t_s, motion| {
        craft.orders_at(level, helm.order_deg(t_s, &motion.body).to_radians())
    });
    let track = track.trajectory(craft.shafts());
    ZigzagMetrics::from_track(&track, angle_deg, switch_deg, &helm.reversals_s).expect("a track")
}

/// Figures of the standard manoeuvres by the names that `sistership manoeuvre` gives them; absent
/// where the craft does not get so far.
pub fn every_figure(craft: &Craft) -> BTreeMap<String, f64> {
    list_figures(|angle| turning(craft, angle), |angle, switch| zigzag(craft, angle, switch))
}

/// Growth rate of a small yaw rate with the steering amidships, by `U/L`: negative for craft that
/// are straight-line stable. A slight asymmetry of the propeller is taken out by a second run.
pub fn growth_rate(craft: &Craft) -> f64 {
    let length_s = craft.size().length_time_s();
    let disturbed = 1e-4 / length_s;
    let orders = craft.orders(1.0, 0.0);
    let run = |rate: f64| {
        let mut from = start(craft, 1.0);
        from.body[at::R] = rate;
        simulate(craft, from, 12.0 * length_s, |_, _| orders)
    };
    let (with, without) = (run(disturbed), run(0.0));
    let apart = |index: usize| {
        let gap: StateVector = with.motions[index].body - without.motions[index].body;
        gap[at::R].hypot(gap[at::V] / craft.size().lpp_m)
    };
    let last = with.motions.len() - 1;
    (apart(last) / apart(last / 2)).ln() / 6.0
}
