//! Simulations that a model must complete before it is chosen: rudder orders, zigzags, motions and
//! revolutions that no trial had. That it comes to rest, stops and goes astern is checked for every
//! refinement, however it is chosen (`sistership_propulsion::check`).

use sistership_identification::refine::{Beginning, Helm, helms, record};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::vessel::Steering;
use sistership_priors::transfer::ready;
use sistership_propulsion::{PropulsionFault, check, check_turning};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, zigzags};
use sistership_simulation::recorded::{Recorded, ReplaySettings, replay_all};

use crate::thresholds::SAILED;

/// Random rudder orders and turns, from straight ahead.
fn asked() -> Vec<Helm> {
    let held = SAILED.turns.into_iter().flat_map(|angle| [angle, -angle]).map(Helm::Held);
    Helm::random(SAILED.records).into_iter().chain(held).collect()
}

/// Returns why a model does not complete a simulation within the range of its rudder and its
/// motion: the order, and where the simulation stops. `None` if it completes all of them, or if the
/// records lack an input of its law.
pub fn unsailed_rudder(model: &Model, law: &Law, trials: &[&Trial]) -> Option<String> {
    let mut helms = helms(model, trials, (&asked(), SAILED.lengths))?;
    helms.extend(from_recorded_motion(model, trials).unwrap_or_default());
    let ship = ready(model, law, trials).ok()?;
    let all: Vec<Recorded<'_>> =
        helms.iter().map(|trial| Recorded { trial, coefficients: &[] }).collect();
    // Records are simulated in lockstep, which makes many of them cheap.
    let runs = replay_all(&ship, &all, &ReplaySettings::default()).ok()?;
    let stopped =
        helms.iter().zip(&runs).find_map(|(helm, run)| Some((helm, run.stopped.as_ref()?)));
    stopped
        .map(|(helm, stopped)| format!("does not sail {}: {stopped}", helm.name))
        .or_else(|| unsailed_zigzag(&ship, &model.steering))
        .or_else(|| propulsion_fault(&ship))
}

/// Fault of a ship with the propeller stopped or reversed, straight ahead or out of a turn. A ship
/// without revolutions to change has none.
fn propulsion_fault(ship: &Ship) -> Option<String> {
    let fault = check(ship).and_then(|()| check_turning(ship)).err()?;
    (fault != PropulsionFault::NoRevolutions).then(|| fault.to_string())
}

/// First zigzag that a ship does not complete, of those to both sides from small angles to the
/// gear's limit.
fn unsailed_zigzag(ship: &Ship, steering: &Steering) -> Option<String> {
    let step_s = ReplaySettings::default().step_s;
    let settings = ManoeuvreSettings { step_s: Some(step_s), ..ManoeuvreSettings::default() };
    // Evenly spaced angles, the last of which is the gear's limit.
    let step_deg = steering.limit_deg / SAILED.zigzags as f64;
    let angles = (1..=SAILED.zigzags).flat_map(|k| [k as f64 * step_deg, -(k as f64) * step_deg]);
    let asked: Vec<(f64, f64)> = angles.map(|angle| (angle, angle.abs())).collect();
    let sailed = asked.iter().zip(zigzags(ship, &asked, &settings));
    let mut stopped = sailed.filter_map(|((angle, _), sailed)| Some((angle, sailed.err()?)));
    let (angle, stopped) = stopped.next()?;
    Some(format!("does not sail a zigzag of {angle:.1} deg: {stopped}"))
}

/// Factors of the recorded revolutions, with their description: the propeller stopped, and
/// reversed.
const ENGINE: [(f64, &str); 2] = [(0.0, ", propeller stopped,"), (-1.0, ", propeller reversed,")];

/// Records that begin in motions of the trials, spread over all of them: a ship gets into motions
/// that the model does not reach by itself. From each the rudder goes hard over to both sides, and
/// moves at random; where revolutions were recorded, the propeller is stopped and reversed with the
/// rudder amidships.
fn from_recorded_motion(model: &Model, trials: &[&Trial]) -> Option<Vec<Trial>> {
    let places: Vec<(&Trial, usize)> =
        trials.iter().flat_map(|trial| (0..trial.len()).map(move |at| (*trial, at))).collect();
    let one = |k: usize, helm: Helm, (turns, engine): (f64, &str)| {
        // The middle of the k-th of `motions` equal parts of all samples.
        let (trial, at) = *places.get((2 * k + 1) * places.len() / (2 * SAILED.motions))?;
        let of = |channel: Channel| Some((channel, trial.channel(channel)?[at]));
        // A sample that lacks one of these cannot start a record; other channels start as recorded.
        let angle_rad = of(Channel::Delta)?.1;
        let moving = [Channel::U, Channel::V, Channel::R].map(of).into_iter();
        let moving = moving.collect::<Option<Vec<_>>>()?;
        let revolutions = of(Channel::N).map(|(channel, n_rps)| (channel, turns * n_rps));
        let others = [Channel::P, Channel::Phi].into_iter().filter_map(of).chain(revolutions);
        let begun = Beginning { channels: moving.into_iter().chain(others).collect(), angle_rad };
        let record = record(model, trials, (helm, SAILED.motion_lengths), &begun)?;
        let begun = format!("from the motion of {} at {:.0} s", trial.name, trial.t_s[at]);
        Some(Trial { name: format!("{}{engine} {begun}", record.name), ..record })
    };
    let helms = |k: usize| [Helm::Held(1.0), Helm::Held(-1.0), Helm::Random(SAILED.records + k)];
    let steered = |k: usize| helms(k).map(|helm| one(k, helm, (1.0, "")));
    let driven = |k: usize| ENGINE.map(|engine| one(k, Helm::Held(0.0), engine));
    let has_revolutions = trials.iter().all(|trial| trial.channel(Channel::N).is_some());
    let engines = if has_revolutions { SAILED.motions } else { 0 };
    let all = (0..SAILED.motions).flat_map(steered);
    all.chain((0..engines).flat_map(driven)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_identification::testing::{mariner, trials, with};

    #[test]
    fn what_leaves_the_physical_range_is_told_with_its_record() {
        let (model, law) = mariner();
        let trials = trials(&model, &law, 0.0);
        let trials: Vec<&Trial> = trials.iter().collect();
        assert_eq!(unsailed_rudder(&model, &law, &trials), None);
        let runs_away = with(&model, |name| if name == "N_r" { -10.0 } else { 1.0 });
        let told = unsailed_rudder(&runs_away, &law, &trials).unwrap();
        assert!(told.starts_with("does not sail rudder 1 at random: stopped at "), "{told}");
    }

    #[test]
    fn trials_without_a_whole_motion_leave_what_begins_straight_ahead() {
        let (model, law) = mariner();
        let mut trials = trials(&model, &law, 0.0);
        let count = |trials: &[Trial]| {
            let trials: Vec<&Trial> = trials.iter().collect();
            from_recorded_motion(&model, &trials).map(|records| records.len())
        };
        assert_eq!(count(&trials), Some(3 * SAILED.motions));
        trials[3].channels.remove(&Channel::Delta);
        assert_eq!(count(&trials), None);
        let trials: Vec<&Trial> = trials.iter().collect();
        let runs_away = with(&model, |name| if name == "N_r" { -10.0 } else { 1.0 });
        assert!(unsailed_rudder(&runs_away, &law, &trials).is_some());
    }
}
