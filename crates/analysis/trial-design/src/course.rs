//! Simulation of a candidate by the model: the track that would be recorded, and the time of all
//! its phases.

use sistership_simulation::manoeuvre::{Manoeuvre, ManoeuvreSettings, simulate_manoeuvre_batch};
use sistership_simulation::state::{StateVector, Trajectory, at, horizontal_speed};
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship};

use crate::candidates::ManoeuvreCandidate;
use crate::thresholds::THRESHOLDS;

/// A simulated candidate.
#[derive(Debug, Clone)]
pub(crate) struct SimulatedCandidate {
    pub candidate: ManoeuvreCandidate,
    /// Track, with the run before the rudder is executed.
    pub track: Trajectory,
    /// Time from the execution of the rudder to the end, s.
    pub manoeuvre_s: f64,
    /// Time with the approach, and until the ship is steady at its full speed again, s.
    pub takes_s: f64,
}

/// Simulates candidates at one speed in lockstep; the error is the reason, where one leaves the
/// physical range.
pub(crate) fn simulate_candidates(
    ship: &Ship,
    candidates: &[ManoeuvreCandidate],
) -> Vec<Result<SimulatedCandidate, String>> {
    let Some(first) = candidates.first() else { return Vec::new() };
    let speed_m_s = first.speed * ship.approach_speed_m_s();
    let length_s = ship.lpp_m() / speed_m_s;
    let settings = ManoeuvreSettings {
        speed_m_s: Some(speed_m_s),
        run_in_s: THRESHOLDS.run_in * length_s,
        ..ManoeuvreSettings::default()
    };
    // Turns need a limit of their duration; zigzags end by themselves.
    let (turns, zigzags): (Vec<ManoeuvreCandidate>, Vec<ManoeuvreCandidate>) =
        candidates.iter().partition(|one| matches!(one.manoeuvre, Manoeuvre::Turn { .. }));
    let longest = ManoeuvreSettings { duration_s: Some(THRESHOLDS.longest * length_s), ..settings };
    let sail = |all: &[ManoeuvreCandidate], settings: &ManoeuvreSettings| {
        let manoeuvres: Vec<(Manoeuvre, &[f64])> =
            all.iter().map(|one| (one.manoeuvre, &[] as &[f64])).collect();
        let sailed = simulate_manoeuvre_batch(ship, &manoeuvres, settings);
        let one = |(candidate, sailed): (&ManoeuvreCandidate, _)| {
            complete_candidate(ship, *candidate, sailed, settings.run_in_s)
        };
        all.iter().zip(sailed.into_iter().map(extract_track)).map(one).collect::<Vec<_>>()
    };
    let mut all = sail(&turns, &longest);
    all.extend(sail(&zigzags, &settings));
    all
}

fn extract_track(
    sailed: Result<
        sistership_simulation::manoeuvre::SimulatedManoeuvre,
        sistership_simulation::SimulationStop,
    >,
) -> Result<Trajectory, String> {
    sailed.map(|sailed| sailed.track).map_err(|stopped| stopped.to_string())
}

fn complete_candidate(
    ship: &Ship,
    candidate: ManoeuvreCandidate,
    track: Result<Trajectory, String>,
    run_in_s: f64,
) -> Result<SimulatedCandidate, String> {
    let name = |reason: String| format!("{}: {reason}", candidate.manoeuvre);
    let track = cut_track(track.map_err(name)?);
    let last = *track.last().ok_or_else(|| name("no manoeuvre was simulated".into()))?;
    let end_s = track.t_s.last().copied().unwrap_or_default();
    let full = ship.approach_speed_m_s();
    // A slower approach also costs the time of slowing down from full speed.
    let slower = straight_at(full);
    let slowing_s =
        if candidate.speed == 1.0 { 0.0 } else { recovery_s(ship, slower, candidate.speed * full) };
    let takes_s = slowing_s + end_s + recovery_s(ship, last, full);
    Ok(SimulatedCandidate { candidate, manoeuvre_s: end_s - run_in_s, track, takes_s })
}

fn straight_at(speed_m_s: f64) -> StateVector {
    sistership_simulation::state::straight_state(speed_m_s)
}

/// Cuts a track where the ship has turned by the heading change of a turning circle.
fn cut_track(track: Trajectory) -> Trajectory {
    let most = THRESHOLDS.turned_deg.to_radians();
    let end = track.states.iter().position(|state| state[at::PSI].abs() >= most);
    let mut kept = Trajectory::default();
    for k in 0..end.map_or(track.t_s.len(), |end| end + 1) {
        kept.push(track.t_s[k], track.states[k], track.n_rps[k]);
    }
    kept
}

/// Time until the ship is steady at a speed, on any heading, s.
fn recovery_s(ship: &Ship, from: StateVector, speed_m_s: f64) -> f64 {
    let length_s = ship.lpp_m() / speed_m_s;
    let given = THRESHOLDS;
    let (psi, n_rps) = (from[at::PSI], ship.revolutions_at(speed_m_s));
    let most = given.helm_deg.to_radians();
    // Steady: speed and yaw rate are both near their values on a straight course.
    let is_steady = |state: &StateVector| {
        (horizontal_speed(state) / speed_m_s - 1.0).abs() < given.steady_speed
            && state[at::R].abs() * length_s < given.steady_rate
    };
    // Proportional and derivative steering to the heading at the end of the manoeuvre; ends when
    // steady.
    let bridge = |_: f64, state: &StateVector| {
        let [by_heading, by_rate] = given.helm;
        let error = by_heading * (state[at::PSI] - psi) + by_rate * state[at::R] * length_s;
        let order = HelmOrder { delta_rad: (-error).clamp(-most, most), n_rps };
        (!is_steady(state)).then_some(order)
    };
    let run = RunSettings {
        start: from,
        duration_s: given.recovery * length_s,
        step_s: given.interval * length_s,
        method: Method::Rk4,
    };
    let mut track = Trajectory::default();
    // A ship that leaves the physical range while it steadies takes the longest time allowed.
    match ship.simulate_orders(run, &mut track, bridge) {
        Ok(()) => track.t_s.last().copied().unwrap_or_default(),
        Err(_) => run.duration_s,
    }
}
