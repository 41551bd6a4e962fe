//! Simulation of the manoeuvre of the playground.

use sistership_model::trial::{Channel, Trial};
use sistership_report::numbers::significant;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, turn, zigzag};
use sistership_simulation::metrics::{TurningMetrics, ZigzagMetrics};
use sistership_simulation::recorded::{ReplaySettings, replay};
use sistership_simulation::{Ship, Trajectory};

use super::orders::{Kind, Line, Orders};
use crate::error::{PageError, Result};

/// Longest time step, s.
const STEP_S: f64 = 0.1;

/// Name, value and unit of each figure.
pub(super) type Figures = Vec<(&'static str, String, &'static str)>;

/// A simulation with its figures.
pub(super) struct Run {
    pub track: Trajectory,
    pub figures: Figures,
    pub notes: Vec<String>,
}

/// Simulates the orders in at most `most` steps.
///
/// # Errors
/// Returns an error if it would take more steps, or if the motion leaves the physical range.
pub(super) fn sailed(ship: &mut Ship, orders: &Orders, most: usize) -> Result<Run> {
    let speed = orders.speed_m_s.unwrap_or(ship.approach_speed_m_s());
    // The range of speeds in which the simulation counts as physical follows the approach speed.
    ship.set_envelope_speed(speed);
    let (track, figures) = match orders.kind {
        Kind::Script => (scripted(ship, orders, speed, most)?, Vec::new()),
        _ => standard(ship, orders, speed, most)?,
    };
    let mut notes = Vec::new();
    if let Some(outside) = ship.leaves(&track) {
        notes.push(format!(
            "{:.0} % of this run lies outside what the model's trials covered, first after {:.0} \
             s, by {}.",
            100.0 * outside.share,
            outside.first_s,
            outside.along
        ));
    }
    Ok(Run { track, figures, notes })
}

fn standard(
    ship: &Ship,
    orders: &Orders,
    speed: f64,
    most: usize,
) -> Result<(Trajectory, Figures)> {
    // The step and the default duration follow the time in which the ship passes its own length.
    let length_s = ship.lpp_m() / speed;
    let step_s = STEP_S.min(0.02 * length_s);
    bounded(orders.duration_s.unwrap_or(60.0 * length_s) / step_s, most)?;
    let settings = ManoeuvreSettings {
        speed_m_s: Some(speed),
        n_rps: orders.n_rpm.map(|rpm| rpm / 60.0),
        duration_s: orders.duration_s,
        step_s: Some(step_s),
        ..ManoeuvreSettings::default()
    };
    let left = |stopped: sistership_simulation::Stopped| {
        PageError::invalid(
            "rudder",
            format!(
                "the simulation left the physical range, {stopped}; the model does not hold there"
            ),
        )
    };
    Ok(match orders.kind {
        Kind::Zigzag => {
            let run =
                zigzag(ship, orders.rudder_deg, orders.switch_deg, &settings).map_err(left)?;
            (run.track, of_zigzag(&run.metrics))
        }
        _ => {
            let run = turn(ship, orders.rudder_deg, &settings).map_err(left)?;
            (run.track, of_turn(&run.metrics))
        }
    })
}

fn bounded(steps: f64, most: usize) -> Result<()> {
    match steps <= most as f64 {
        true => Ok(()),
        false => Err(PageError::invalid(
            "speed",
            format!("would take {steps:.0} steps, at most {most} are made: faster, or shorter"),
        )),
    }
}

fn of_turn(metrics: &TurningMetrics) -> Figures {
    let figures = [
        ("advance", metrics.advance_m, "m"),
        ("transfer", metrics.transfer_m, "m"),
        ("tactical diameter", metrics.tactical_diameter_m, "m"),
        ("steady turning radius", metrics.steady_radius_m, "m"),
        ("speed loss", Some(metrics.speed_loss_m_s), "m/s"),
    ];
    known(&figures)
}

fn of_zigzag(metrics: &ZigzagMetrics) -> Figures {
    let figures = [
        ("first overshoot", metrics.first_overshoot_deg, "deg"),
        ("second overshoot", metrics.second_overshoot_deg, "deg"),
        ("initial turning time", metrics.initial_turning_time_s, "s"),
        ("period", metrics.period_s, "s"),
    ];
    known(&figures)
}

fn known(figures: &[(&'static str, Option<f64>, &'static str)]) -> Figures {
    let text = |value: Option<f64>| {
        value.map_or_else(|| "not reached".to_owned(), |value| significant(value, 4))
    };
    figures.iter().map(|&(name, value, unit)| (name, text(value), unit)).collect()
}

/// Simulates a script like recorded inputs: the rudder angle is that of the script, linear between
/// its times.
fn scripted(ship: &Ship, orders: &Orders, speed: f64, most: usize) -> Result<Trajectory> {
    let lines = orders.lines()?;
    let settings = ReplaySettings::default();
    let trial = trial(ship, &lines, orders, speed);
    bounded(trial.duration_s() / settings.step_s + trial.len() as f64, most)?;
    let run = replay(ship, &trial, &settings)
        .map_err(|error| PageError::invalid("script", error.to_string()))?;
    Ok(run.track)
}

/// Returns the script as a trial with evenly spaced samples that starts straight ahead at a speed,
/// m/s.
fn trial(ship: &Ship, lines: &[Line], orders: &Orders, speed: f64) -> Trial {
    let (first, last) = (lines[0].0, lines[lines.len() - 1].0);
    // About one sample a second, at most 4000.
    let count = ((last - first).ceil() as usize).clamp(2, 4000);
    let t_s: Vec<f64> =
        (0..=count).map(|k| first + (last - first) * k as f64 / count as f64).collect();
    let steady = orders.n_rpm.map_or(ship.revolutions_at(speed), |rpm| rpm / 60.0);
    let delta = t_s.iter().map(|t| between(lines, *t, |line| line.1)).collect();
    let n = t_s.iter().map(|t| between(lines, *t, |line| line.2.unwrap_or(steady))).collect();
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
    trial
}

/// Interpolates linearly between the lines of a script; constant before the first and after the
/// last.
fn between(lines: &[Line], t: f64, of: impl Fn(&Line) -> f64) -> f64 {
    let after = lines.partition_point(|line| line.0 <= t);
    match (after.checked_sub(1).map(|before| &lines[before]), lines.get(after)) {
        (Some(a), Some(b)) => of(a) + (of(b) - of(a)) * (t - a.0) / (b.0 - a.0),
        (Some(one), None) | (None, Some(one)) => of(one),
        (None, None) => 0.0,
    }
}
