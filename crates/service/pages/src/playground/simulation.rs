//! Simulation of the manoeuvre of the playground.

use sistership_model::trial::{Channel, Trial};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::metrics::{TurningMetrics, ZigzagMetrics};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_simulation::{Ship, Trajectory};

use super::orders::{ManoeuvreKind, ManoeuvreOrders, ScriptLine};
use crate::error::{PageError, Result};
use crate::language::{Message, say, say_word};
use crate::numbers::{format_fixed, format_significant};

/// Longest time step, s.
const STEP_S: f64 = 0.1;

/// Name, value and unit of each figure; no unit where the manoeuvre did not reach it.
pub(super) type FigureList = Vec<(String, String, &'static str)>;

/// A simulation with its figures.
pub(super) struct PlaygroundRun {
    pub track: Trajectory,
    pub figures: FigureList,
    pub notes: Vec<String>,
}

/// Simulates the orders in at most `most` steps.
///
/// # Errors
/// Returns an error if it would take more steps, or if the motion leaves the physical range.
pub(super) fn simulate_orders(
    ship: &mut Ship,
    orders: &ManoeuvreOrders,
    most: usize,
) -> Result<PlaygroundRun> {
    let speed = orders.speed_m_s.unwrap_or(ship.approach_speed_m_s());
    // The range of speeds in which the simulation counts as physical follows the approach speed.
    ship.set_envelope_speed(speed);
    let (track, figures) = match orders.kind {
        ManoeuvreKind::Script => (simulate_script(ship, orders, speed, most)?, Vec::new()),
        _ => simulate_standard(ship, orders, speed, most)?,
    };
    let mut notes = Vec::new();
    if let Some(outside) = ship.find_excursion(&track) {
        let note = say("playground-outside").with("share", format_fixed(100.0 * outside.share, 0));
        let note = note.with("first", format_fixed(outside.first_s, 0));
        notes.push(note.with("along", outside.along.to_string()).into());
    }
    Ok(PlaygroundRun { track, figures, notes })
}

fn simulate_standard(
    ship: &Ship,
    orders: &ManoeuvreOrders,
    speed: f64,
    most: usize,
) -> Result<(Trajectory, FigureList)> {
    // The step and the default duration follow the time in which the ship passes its own length.
    let length_s = ship.lpp_m() / speed;
    let step_s = STEP_S.min(0.02 * length_s);
    let steps = orders.duration_s.unwrap_or(60.0 * length_s) / step_s;
    // The default duration follows the speed, and has a fixed number of steps unless the speed is
    // low.
    let remedy = match orders.duration_s {
        Some(_) => StepRemedy { field: "duration", says: say("playground-shorter-time") },
        None => StepRemedy { field: "speed", says: say("playground-higher-speed") },
    };
    check_step_count(steps, most, remedy)?;
    let settings = ManoeuvreSettings {
        speed_m_s: Some(speed),
        n_rps: orders.n_rpm.map(|rpm| rpm / 60.0),
        duration_s: orders.duration_s,
        step_s: Some(step_s),
        ..ManoeuvreSettings::default()
    };
    let left = |stopped: sistership_simulation::SimulationStop| {
        let message = say("playground-left").with("stopped", stopped.to_string());
        PageError::invalid_field("rudder", message)
    };
    Ok(match orders.kind {
        ManoeuvreKind::Zigzag => {
            let run = simulate_zigzag(ship, orders.rudder_deg, orders.switch_deg, &settings)
                .map_err(left)?;
            (run.track, zigzag_figures(&run.metrics))
        }
        _ => {
            let run = simulate_turn(ship, orders.rudder_deg, &settings).map_err(left)?;
            (run.track, turn_figures(&run.metrics))
        }
    })
}

/// Field of the form that makes a simulation too long, and how to put it right.
struct StepRemedy {
    field: &'static str,
    says: Message,
}

fn check_step_count(steps: f64, most: usize, remedy: StepRemedy) -> Result<()> {
    match steps <= most as f64 {
        true => Ok(()),
        false => {
            let message = say("playground-steps").with("steps", format_fixed(steps, 0));
            let message = message.with("most", most).with("remedy", remedy.says);
            Err(PageError::invalid_field(remedy.field, message))
        }
    }
}

fn turn_figures(metrics: &TurningMetrics) -> FigureList {
    let figures = [
        ("advance", metrics.advance_m, "m"),
        ("transfer", metrics.transfer_m, "m"),
        ("tactical-diameter", metrics.tactical_diameter_m, "m"),
        ("steady-turning-radius", metrics.steady_radius_m, "m"),
        ("speed-loss", Some(metrics.speed_loss_m_s), "m/s"),
    ];
    format_figures(&figures)
}

fn zigzag_figures(metrics: &ZigzagMetrics) -> FigureList {
    let figures = [
        ("first-overshoot", metrics.first_overshoot_deg, "deg"),
        ("second-overshoot", metrics.second_overshoot_deg, "deg"),
        ("initial-turning-time", metrics.initial_turning_time_s, "s"),
        ("period", metrics.period_s, "s"),
    ];
    format_figures(&figures)
}

fn format_figures(figures: &[(&'static str, Option<f64>, &'static str)]) -> FigureList {
    let row = |&(name, value, unit): &(&'static str, Option<f64>, &'static str)| {
        let name = say_word("figure", name);
        match value {
            Some(value) => (name, format_significant(value, 4), unit),
            None => (name, say("word-not-reached").into(), ""),
        }
    };
    figures.iter().map(row).collect()
}

/// Simulates a script like recorded inputs: the rudder angle is that of the script, linear between
/// its times.
fn simulate_script(
    ship: &Ship,
    orders: &ManoeuvreOrders,
    speed: f64,
    most: usize,
) -> Result<Trajectory> {
    let lines = orders.script_lines()?;
    let settings = ReplaySettings::default();
    let trial = script_trial(ship, &lines, orders, speed);
    let steps = trial.duration_s() / settings.step_s + trial.len() as f64;
    let remedy = StepRemedy { field: "script", says: say("playground-shorter-script") };
    check_step_count(steps, most, remedy)?;
    let run = replay_trial(ship, &trial, &settings)
        .map_err(|error| PageError::invalid_field("script", error.to_string()))?;
    Ok(run.track)
}

/// Returns the script as a trial with evenly spaced samples that starts straight ahead at a speed,
/// m/s.
fn script_trial(ship: &Ship, lines: &[ScriptLine], orders: &ManoeuvreOrders, speed: f64) -> Trial {
    let (first, last) = (lines[0].0, lines[lines.len() - 1].0);
    // About one sample a second, at most 4000.
    let count = ((last - first).ceil() as usize).clamp(2, 4000);
    let t_s: Vec<f64> =
        (0..=count).map(|k| first + (last - first) * k as f64 / count as f64).collect();
    let steady = orders.n_rpm.map_or(ship.revolutions_at(speed), |rpm| rpm / 60.0);
    let delta = t_s.iter().map(|t| interpolate_script(lines, *t, |line| line.1)).collect();
    let n = t_s
        .iter()
        .map(|t| interpolate_script(lines, *t, |line| line.2.unwrap_or(steady)))
        .collect();
    // Only the first state matters: the replay starts from it and reads inputs alone afterwards.
    let mut trial = Trial { name: "script".into(), ..Trial::default() };
    for channel in [
        Channel::U,
        Channel::V,
        Channel::R,
        Channel::Psi,
        Channel::X,
        Channel::Y,
        Channel::Phi,
        Channel::P,
    ] {
        let value = if channel == Channel::U { speed } else { 0.0 };
        trial.channels.insert(channel, vec![value; t_s.len()]);
    }
    trial.channels.extend([(Channel::Delta, delta), (Channel::N, n)]);
    trial.t_s = t_s;
    ship.set_actuators(&mut trial);
    trial
}

/// Interpolates linearly between the lines of a script; constant before the first and after the
/// last.
fn interpolate_script(lines: &[ScriptLine], t: f64, of: impl Fn(&ScriptLine) -> f64) -> f64 {
    let after = lines.partition_point(|line| line.0 <= t);
    match (after.checked_sub(1).map(|before| &lines[before]), lines.get(after)) {
        (Some(a), Some(b)) => of(a) + (of(b) - of(a)) * (t - a.0) / (b.0 - a.0),
        (Some(one), None) | (None, Some(one)) => of(one),
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;

    use super::*;

    /// Returns the field that a run of too many steps is refused by.
    fn refused_field(orders: &ManoeuvreOrders) -> String {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let mut ship = Ship::new(&model, zoo.law(&model.law).unwrap()).unwrap();
        match simulate_orders(&mut ship, orders, 100) {
            Err(PageError::Invalid { field, .. }) => field,
            _ => panic!("a run of more than 100 steps"),
        }
    }

    #[test]
    fn the_field_that_makes_a_run_too_long_is_named() {
        let default = ManoeuvreOrders::default();
        let script = ManoeuvreOrders { kind: ManoeuvreKind::Script, ..default.clone() };
        assert_eq!(refused_field(&script), "script");
        assert_eq!(refused_field(&default), "speed");
        let long = ManoeuvreOrders { duration_s: Some(1000.0), ..default };
        assert_eq!(refused_field(&long), "duration");
    }
}
