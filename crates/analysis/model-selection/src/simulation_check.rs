//! Simulations that a model must complete before it is chosen: rudder orders, zigzags, motions and
//! revolutions that no trial had. That it comes to rest, stops and goes astern is checked for every
//! refinement, however it is chosen (`sistership_propulsion::check`).

use sistership_identification::refine::{RecordStart, RudderOrder, rudder_record, rudder_records};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::vessel::Steering;
use sistership_priors::transfer::prepare_ship;
use sistership_propulsion::{PropulsionFault, check_straight, check_turning};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_zigzags};
use sistership_simulation::recorded::{RecordedTrial, ReplaySettings, TrialReplay, replay_trials};
use sistership_simulation::state::at;

use crate::thresholds::SIMULATION_CHECK;

/// Why a model does not complete a simulation.
#[derive(Debug, Clone, PartialEq)]
pub enum SimulationFault {
    /// Under rudder orders, at the revolutions of the trials.
    Steering(String),
    /// With the propeller stopped or reversed, where trials seldom reach.
    Propulsion(String),
}

impl SimulationFault {
    /// The reason in words.
    pub fn into_reason(self) -> String {
        match self {
            Self::Steering(reason) | Self::Propulsion(reason) => reason,
        }
    }
}

/// Random rudder orders and turns, from straight ahead.
fn rudder_orders() -> Vec<RudderOrder> {
    let held =
        SIMULATION_CHECK.turns.into_iter().flat_map(|angle| [angle, -angle]).map(RudderOrder::Held);
    RudderOrder::random_orders(SIMULATION_CHECK.records).into_iter().chain(held).collect()
}

/// Returns why a model does not complete a simulation within the range of its rudder and its
/// motion: the order, and where the simulation stops. `None` if it completes all of them, or if the
/// records lack an input of its law.
pub fn simulation_fault(model: &Model, law: &Law, trials: &[&Trial]) -> Option<SimulationFault> {
    let helms = rudder_records((model, law), trials, (&rudder_orders(), SIMULATION_CHECK.lengths))?;
    // Motions of the trials may be astern already.
    let moving = motion_records((model, law), trials).unwrap_or_default();
    let ship = prepare_ship(model, law, trials).ok()?;
    // A craft that is steered by a difference of thrust has one thruster astern in a hard turn.
    let steering = match law.steers_by_difference() {
        true => replay_fault(&ship, &helms, completion_fault),
        false => replay_fault(&ship, &helms, ahead_fault),
    };
    let steering = steering.or_else(|| replay_fault(&ship, &moving, completion_fault));
    let steering = steering.or_else(|| zigzag_fault(&ship, &model.steering));
    let propulsion = || {
        let engine = engine_records((model, law), trials).unwrap_or_default();
        let engine = replay_fault(&ship, &engine, completion_fault);
        engine.or_else(|| propulsion_fault(&ship))
    };
    steering
        .map(SimulationFault::Steering)
        .or_else(|| propulsion().map(SimulationFault::Propulsion))
}

/// First fault of a ship in records.
fn replay_fault(
    ship: &Ship,
    records: &[Trial],
    fault: fn(&TrialReplay) -> Option<String>,
) -> Option<String> {
    let all: Vec<RecordedTrial<'_>> =
        records.iter().map(|trial| RecordedTrial { trial, coefficients: &[] }).collect();
    // Records are simulated in lockstep, which makes many of them cheap.
    let runs = replay_trials(ship, &all, &ReplaySettings::default()).ok()?;
    let mut faults = records.iter().zip(&runs).filter_map(|(one, run)| Some((one, fault(run)?)));
    let (record, fault) = faults.next()?;
    Some(format!("does not complete {}: {fault}", record.name))
}

/// Where and why a simulation stops.
fn completion_fault(run: &TrialReplay) -> Option<String> {
    run.stopped.as_ref().map(ToString::to_string)
}

/// The same, or when a ship that begins ahead goes astern, which none does by its rudder while its
/// propeller turns ahead.
fn ahead_fault(run: &TrialReplay) -> Option<String> {
    let astern = || {
        let place = run.track.states.iter().position(|state| state[at::U] < 0.0)?;
        Some(format!("goes astern at {:.0} s with its propeller ahead", run.track.t_s[place]))
    };
    completion_fault(run).or_else(astern)
}

/// Fault of a ship with the propeller stopped or reversed, straight ahead or out of a turn. A ship
/// without revolutions to change has none.
fn propulsion_fault(ship: &Ship) -> Option<String> {
    let fault = check_straight(ship).and_then(|()| check_turning(ship)).err()?;
    (fault != PropulsionFault::NoRevolutions).then(|| fault.to_string())
}

/// First zigzag that a ship does not complete, of those to both sides from small angles to the
/// gear's limit.
fn zigzag_fault(ship: &Ship, steering: &Steering) -> Option<String> {
    let step_s = ReplaySettings::default().step_s;
    let settings = ManoeuvreSettings { step_s: Some(step_s), ..ManoeuvreSettings::default() };
    // Evenly spaced angles, the last of which is the gear's limit.
    let step_deg = steering.limit_deg / SIMULATION_CHECK.zigzags as f64;
    let angles =
        (1..=SIMULATION_CHECK.zigzags).flat_map(|k| [k as f64 * step_deg, -(k as f64) * step_deg]);
    let asked: Vec<(f64, f64)> = angles.map(|angle| (angle, angle.abs())).collect();
    let sailed = asked.iter().zip(simulate_zigzags(ship, &asked, &settings));
    let mut stopped = sailed.filter_map(|((angle, _), sailed)| Some((angle, sailed.err()?)));
    let (angle, stopped) = stopped.next()?;
    Some(format!("does not complete a zigzag of {angle:.1} deg: {stopped}"))
}

/// Factors of the recorded revolutions, with their description: the propeller stopped, and
/// reversed.
const ENGINE: [(f64, &str); 2] = [(0.0, ", propeller stopped,"), (-1.0, ", propeller reversed,")];

/// Records that begin in motions of the trials, spread over all of them: a ship gets into motions
/// that the model does not reach by itself. From each the rudder goes hard over to both sides, and
/// moves at random.
fn motion_records((model, law): (&Model, &Law), trials: &[&Trial]) -> Option<Vec<Trial>> {
    let orders = |k: usize| {
        [
            RudderOrder::Held(1.0),
            RudderOrder::Held(-1.0),
            RudderOrder::Random(SIMULATION_CHECK.records + k),
        ]
    };
    let steered =
        |k: usize| orders(k).map(|order| motion_record((model, law), trials, k, order, (1.0, "")));
    (0..SIMULATION_CHECK.motions).flat_map(steered).collect()
}

/// Records from the same motions with the propeller stopped and reversed and the rudder amidships;
/// `None` if a trial has no revolutions.
fn engine_records((model, law): (&Model, &Law), trials: &[&Trial]) -> Option<Vec<Trial>> {
    if trials.iter().any(|trial| trial.channel(Channel::N).is_none()) {
        return None;
    }
    let driven = |k: usize| {
        ENGINE.map(|engine| motion_record((model, law), trials, k, RudderOrder::Held(0.0), engine))
    };
    (0..SIMULATION_CHECK.motions).flat_map(driven).collect()
}

/// A record that begins in the middle of the k-th of equal parts of all samples; `None` if that
/// sample lacks a speed, the yaw rate or the rudder.
fn motion_record(
    (model, law): (&Model, &Law),
    trials: &[&Trial],
    k: usize,
    order: RudderOrder,
    (turns, engine): (f64, &str),
) -> Option<Trial> {
    let places: Vec<(&Trial, usize)> =
        trials.iter().flat_map(|trial| (0..trial.len()).map(move |at| (*trial, at))).collect();
    let (trial, at) = *places.get((2 * k + 1) * places.len() / (2 * SIMULATION_CHECK.motions))?;
    let of = |channel: Channel| Some((channel, trial.channel(channel)?[at]));
    // A craft without a rudder begins with its helm amidships.
    let angle_rad = match law.steers_by_difference() {
        true => 0.0,
        false => of(Channel::Delta)?.1,
    };
    let moving = [Channel::U, Channel::V, Channel::R].map(of).into_iter();
    let moving = moving.collect::<Option<Vec<_>>>()?;
    let revolutions = of(Channel::N).map(|(channel, n_rps)| (channel, turns * n_rps));
    let others = [Channel::P, Channel::Phi].into_iter().filter_map(of).chain(revolutions);
    let start = RecordStart { channels: moving.into_iter().chain(others).collect(), angle_rad };
    let record =
        rudder_record((model, law), trials, (order, SIMULATION_CHECK.motion_lengths), &start)?;
    let from = format!("from the motion of {} at {:.0} s", trial.name, trial.t_s[at]);
    Some(Trial { name: format!("{}{engine} {from}", record.name), ..record })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_identification::testing::{
        mariner_model, simulated_trials, with_scaled_coefficients,
    };

    #[test]
    fn what_leaves_the_physical_range_is_told_with_its_record() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let trials: Vec<&Trial> = trials.iter().collect();
        assert_eq!(simulation_fault(&model, &law, &trials), None);
        let runs_away =
            with_scaled_coefficients(&model, |name| if name == "N_r" { -10.0 } else { 1.0 });
        let fault = simulation_fault(&runs_away, &law, &trials).unwrap();
        assert!(matches!(fault, SimulationFault::Steering(_)), "{fault:?}");
        let told = fault.into_reason();
        assert!(
            told.starts_with("does not complete random rudder orders 1: stopped at "),
            "{told}"
        );
    }

    #[test]
    fn trials_without_a_whole_motion_leave_what_begins_straight_ahead() {
        let (model, law) = mariner_model();
        let mut trials = simulated_trials(&model, &law, 0.0);
        let count = |trials: &[Trial]| {
            let trials: Vec<&Trial> = trials.iter().collect();
            motion_records((&model, &law), &trials).map(|records| records.len())
        };
        assert_eq!(count(&trials), Some(3 * SIMULATION_CHECK.motions));
        trials[3].channels.remove(&Channel::Delta);
        assert_eq!(count(&trials), None);
        let trials: Vec<&Trial> = trials.iter().collect();
        let runs_away =
            with_scaled_coefficients(&model, |name| if name == "N_r" { -10.0 } else { 1.0 });
        assert!(simulation_fault(&runs_away, &law, &trials).is_some());
    }
}
