//! What is sailed: the scenarios of Kanazawa 2023, secs. 3.1.2 to 3.3.2 and 4.1.2.

use std::f64::consts::{PI, TAU};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;
use sistership_model::Trial;

use super::hull::Hull;
use super::sailed::{Start, sail};
use super::weather::Weather;

/// Revolutions on trial, 1/s: ranges are by these.
const TRIAL_RPS: f64 = 2.75;

fn rng(seed: u64) -> ChaCha12Rng {
    ChaCha12Rng::seed_from_u64(seed)
}

/// Scenarios in parallel, each by a seed of its own.
pub fn all(count: usize, seed: u64, one: impl Fn(u64) -> Trial + Sync) -> Vec<Trial> {
    (0..count as u64).into_par_iter().map(|k| one(1000 * seed + k)).collect()
}

/// Paper I: revolutions to n_max until T_n, then half; an angle until T_delta, then none. The
/// record begins at 55 s, five after the angle.
pub fn commands(hull: &Hull, force: u8, seed: u64) -> Trial {
    let mut rng = rng(seed);
    let n = rng.random_range(50.0..130.0) / 60.0;
    let delta: f64 = rng.random_range(-20.0_f64..20.0).to_radians();
    let weather = Weather::beaufort(force, rng.random_range(0.0..TAU));
    let (slows, straightens) =
        (55.0 + rng.random_range(20.0..50.0), 55.0 + rng.random_range(80.0..110.0));
    let start =
        Start { u_m_s: hull.speed_m_s(n / TRIAL_RPS), psi_rad: 0.0, n_rps: n, delta_rad: 0.0 };
    sail(hull, &weather, start, [55.0, 215.0], seed, &|t_s| {
        let turns = (50.0..straightens).contains(&t_s);
        [if t_s < slows { n } else { 0.5 * n }, if turns { delta } else { 0.0 }]
    })
}

/// Paper II: an angle to one side until T, to the other until twice that, then none.
pub fn zigzag(hull: &Hull, force: Option<u8>, seed: u64) -> Trial {
    let mut rng = rng(seed);
    let towards = rng.random_range(0.0..TAU);
    let weather = force.map_or(Weather::CALM, |force| Weather::beaufort(force, towards));
    let delta: f64 = rng.random_range(-35.0_f64..35.0).to_radians();
    let over = rng.random_range(50.0..75.0);
    let n = (130.0 + 10.0 * normal(&mut rng)) / 60.0;
    let u_m_s: f64 = (4.0 + normal(&mut rng)).max(0.5);
    let start = Start { u_m_s, psi_rad: 0.0, n_rps: n, delta_rad: 0.0 };
    sail(hull, &weather, start, [5.0, 185.0], seed, &|t_s| {
        let t_s = t_s - 5.0;
        let angle = if t_s < over {
            delta
        } else if t_s < 2.0 * over {
            -delta
        } else {
            0.0
        };
        [n, angle]
    })
}

/// Paper III: from speed, a turn while the revolutions are taken back by steps, and at last only so
/// much way that it can be laid alongside.
pub fn docking(hull: &Hull, seed: u64) -> Trial {
    let mut rng = rng(seed);
    let force = if rng.random::<bool>() { 3 } else { 0 };
    let towards = rng.random_range(0.0..TAU);
    let weather = if force == 3 { Weather::beaufort(3, towards) } else { Weather::CALM };
    let n = rng.random_range(110.0..165.0) / 60.0;
    let psi_rad = rng.random_range(0.0..TAU);
    // Sections of 30 to 60 s, each with fewer revolutions and an angle of its own.
    let mut plan = vec![(0.0, n, 0.0)];
    let mut t_s = 60.0;
    for share in [0.7, 0.5, 0.35, 0.25, 0.15, 0.1] {
        let angle: f64 = rng.random_range(-35.0_f64..35.0).to_radians();
        plan.push((t_s, share * n, angle));
        t_s += rng.random_range(30.0..60.0);
    }
    let start = Start { u_m_s: hull.speed_m_s(n / TRIAL_RPS), psi_rad, n_rps: n, delta_rad: 0.0 };
    sail(hull, &weather, start, [20.0, t_s + 40.0], seed, &|t_s| {
        let now = plan.iter().rev().find(|(from, ..)| t_s >= *from);
        now.map_or([n, 0.0], |(_, n, delta)| [*n, *delta])
    })
}

/// Paper IV: a turn under orders that stay, in wind to 6 m/s and waves of 1 m and 5 s.
pub fn turning(hull: &Hull, seed: u64) -> Trial {
    let mut rng = rng(seed);
    let n = rng.random_range(50.0..200.0) / 60.0;
    let delta: f64 = rng.random_range(-50.0_f64..50.0).to_radians();
    let wind_m_s = rng.random_range(0.0..6.0);
    let towards_rad = rng.random_range(0.0..TAU);
    let weather = Weather { height_m: 1.0, period_s: 5.0, wind_m_s, current_m_s: 0.0, towards_rad };
    let u_m_s = rng.random_range(0.3..1.0) * hull.speed_m_s((n / TRIAL_RPS).min(1.0));
    let psi_rad = rng.random_range(-PI..PI);
    let n = hull.revolutions() * n;
    let start = Start { u_m_s, psi_rad, n_rps: n, delta_rad: delta };
    sail(hull, &weather, start, [5.0, 85.0], seed, &|_| [n, delta])
}

/// Box and Muller.
pub fn normal(rng: &mut ChaCha12Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (TAU * rng.random::<f64>()).cos()
}
