//! Quantities of recorded turning circles and zigzags, each simulated with the recorded rudder.

use std::collections::BTreeMap;

use sistership_model::trial::Trial;
use sistership_simulation::Ship;
use sistership_simulation::metrics::{ManoeuvreMetrics, ManoeuvreRecognition, recorded_track};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use crate::validation::convergence::step_uncertainty;
use crate::validation::published::draw_uncertainty;
use crate::validation::quantity::{QuantityEvidence, mean_uncertainty};
use crate::validation::trial_of_ship::TrialOfShip;

/// Steps of the simulations, relative to the finest.
const STEPS: [f64; 3] = [1.0, 2.0, 4.0];

/// A figure of one trial: measured, by three steps, and by every draw.
struct FigureReading {
    trial: String,
    measured: f64,
    by_step: [Option<f64>; 3],
    by_draw: Vec<Option<f64>>,
}

/// Returns the evidence on every figure of the manoeuvres among trials; trials of the same
/// manoeuvre are repeats of it.
pub fn recorded_evidence(
    ship: &Ship,
    draws: &[Ship],
    trials: &[TrialOfShip<'_>],
) -> Vec<QuantityEvidence> {
    let mut readings: BTreeMap<(String, &'static str), Vec<FigureReading>> = BTreeMap::new();
    for trial in trials.iter().filter(|trial| !trial.fitted) {
        for (quantity, unit, reading) in trial_readings(ship, draws, trial) {
            readings.entry((quantity, unit)).or_default().push(reading);
        }
    }
    readings
        .iter()
        .map(|((quantity, unit), repeats)| combine_repeats(quantity, unit, repeats))
        .collect()
}

/// Means over repeats. The rudder of each was slightly different, so that the scatter of the data
/// is that of D - S.
fn combine_repeats(
    quantity: &str,
    unit: &'static str,
    repeats: &[FigureReading],
) -> QuantityEvidence {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let simulated = |place: usize| -> Option<Vec<f64>> {
        repeats.iter().map(|one| one.by_step[place]).collect()
    };
    let fine = simulated(0);
    let steps = [0, 1, 2].map(|place| simulated(place).map(|all| mean(&all)));
    let errors = fine.as_ref().map(|all| {
        repeats.iter().zip(all).map(|(one, simulated)| one.measured - simulated).collect::<Vec<_>>()
    });
    // Only draws that every repeat has.
    let draws = repeats.iter().map(|one| one.by_draw.len()).min().unwrap_or(0);
    let of_draw = |draw: usize| -> Option<f64> {
        let all: Option<Vec<f64>> = repeats.iter().map(|one| one.by_draw[draw]).collect();
        all.map(|all| mean(&all))
    };
    QuantityEvidence {
        quantity: quantity.to_owned(),
        unit,
        data_from: repeats.iter().map(|one| one.trial.as_str()).collect::<Vec<_>>().join(", "),
        records: Some(repeats.len()),
        data: mean(&repeats.iter().map(|one| one.measured).collect::<Vec<_>>()),
        simulated: steps[0],
        data_uncertainty: errors.and_then(|errors| mean_uncertainty(&errors)),
        step_uncertainty: match steps {
            [Some(fine), Some(medium), Some(coarse)] => step_uncertainty([fine, medium, coarse]),
            _ => None,
        },
        input_uncertainty: draw_uncertainty(&(0..draws).map(of_draw).collect::<Vec<_>>()),
    }
}

fn trial_readings(
    ship: &Ship,
    draws: &[Ship],
    of_ship: &TrialOfShip<'_>,
) -> Vec<(String, &'static str, FigureReading)> {
    let trial = of_ship.trial;
    let (Some(recognised), Some(track)) =
        (ManoeuvreRecognition::from_trial(trial), recorded_track(trial))
    else {
        return Vec::new();
    };
    let samples: Vec<usize> = (0..trial.len()).collect();
    let Some(measured) = recognised.track_metrics(&track, &samples) else { return Vec::new() };
    let (label, measured) = named_figures(&measured);
    let interval_s = trial.duration_s() / (trial.len().max(2) - 1) as f64;
    let usual_s = ReplaySettings::default().step_s.min(interval_s);
    // A step is a part of a sampling interval: the coarsest is a whole one.
    let finest_s = usual_s / STEPS[2];
    let by_step = STEPS.map(|steps| simulated_figures(ship, trial, &recognised, steps * finest_s));
    let by_draw: Vec<_> =
        draws.iter().map(|draw| simulated_figures(draw, trial, &recognised, usual_s)).collect();
    let reading = |(k, (figure, unit, value)): (usize, FigureValue)| {
        // Figures have the same order in every simulation of a trial.
        let read = |all: &Option<Vec<FigureValue>>| all.as_ref().and_then(|all| all[k].2);
        let reading = FigureReading {
            trial: of_ship.name.to_owned(),
            measured: value?,
            by_step: by_step.each_ref().map(read),
            by_draw: by_draw.iter().map(read).collect(),
        };
        Some((format!("{label}: {figure}"), unit, reading))
    };
    measured.into_iter().enumerate().filter_map(reading).collect()
}

/// Name, unit, value.
type FigureValue = (&'static str, &'static str, Option<f64>);

/// The figures of a trial simulated with the recorded rudder; `None` if the simulation stops early
/// or the trial lacks a channel.
fn simulated_figures(
    ship: &Ship,
    trial: &Trial,
    recognised: &ManoeuvreRecognition,
    step_s: f64,
) -> Option<Vec<FigureValue>> {
    let settings = ReplaySettings { step_s, ..ReplaySettings::default() };
    let run = replay_trial(ship, trial, &settings).ok().filter(|run| run.stopped.is_none())?;
    Some(named_figures(&recognised.track_metrics(&run.track, &run.samples)?).1)
}

/// The manoeuvre, and its figures. The period of a zigzag is that of the recorded rudder, so that
/// it is no evidence.
fn named_figures(metrics: &ManoeuvreMetrics) -> (String, Vec<FigureValue>) {
    match metrics {
        ManoeuvreMetrics::Turn(turn) => (
            format!("turn {:.0} deg", turn.rudder_deg),
            vec![
                ("advance", "m", turn.advance_m),
                ("transfer", "m", turn.transfer_m),
                ("tactical diameter", "m", turn.tactical_diameter_m),
                ("steady radius", "m", turn.steady_radius_m),
            ],
        ),
        ManoeuvreMetrics::Zigzag(zigzag) => (
            format!("zigzag {}/{}", zigzag.rudder_deg, zigzag.switch_deg),
            vec![
                ("first overshoot", "deg", zigzag.first_overshoot_deg),
                ("second overshoot", "deg", zigzag.second_overshoot_deg),
            ],
        ),
    }
}
