//! Plotted trials, simulated by the source and by the refined model.

use std::collections::BTreeMap;

use sistership_model::Model;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{ReplaySettings, TrialReplay, replay_trial};
use sistership_simulation::{PlantError, Ship};

use super::input::RefinementInput;
use crate::plots::HullOutline;
use crate::replayed::{ReplaySummary, ReplayedTrial};

/// Largest number of plotted trials.
const MOST: usize = 4;

/// Simulates the most informative trials; those that lack a channel are omitted.
pub(crate) fn replay_chosen<'a>(
    input: &RefinementInput<'a>,
) -> Result<Vec<ReplayedTrial<'a>>, PlantError> {
    let source = prepare_ship(&input.refinement.transferred, input)?;
    let refined = prepare_ship(&input.refinement.model, input)?;
    let settings = ReplaySettings::default();
    let one = |trial: &'a Trial| {
        let runs = (
            replay_trial(&source, trial, &settings).ok()?,
            replay_trial(&refined, trial, &settings).ok()?,
        );
        Some(replayed_trial(input, trial, runs))
    };
    Ok(ranked_trials(input).into_iter().filter_map(one).take(MOST).collect())
}

fn replayed_trial<'a>(
    input: &RefinementInput<'a>,
    trial: &'a Trial,
    (source, refined): (TrialReplay, TrialReplay),
) -> ReplayedTrial<'a> {
    let stopped = |run: &TrialReplay| run.stopped.as_ref().map(ToString::to_string);
    let shown = ReplaySummary {
        trial: &trial.name,
        manoeuvre: trial.manoeuvre.as_deref(),
        duration_s: trial.duration_s(),
        fitted: is_fitted(input, trial) && !input.refinement.is_source_kept(),
        source: SquaredError::from_trial(trial, &source).rmse_by_channel(),
        refined: SquaredError::from_trial(trial, &refined).rmse_by_channel(),
        source_stopped: stopped(&source),
        refined_stopped: stopped(&refined),
    };
    let hull = HullOutline::from_particulars(&input.refinement.model.particulars);
    ReplayedTrial { trial, source, refined, rolls: input.law.has_roll(), hull, shown }
}

fn is_fitted(input: &RefinementInput<'_>, trial: &Trial) -> bool {
    !input.refinement.settings.held_out.contains(&trial.name)
}

/// Ship whose envelope covers the speeds of the trials.
fn prepare_ship(model: &Model, input: &RefinementInput<'_>) -> Result<Ship, PlantError> {
    let mut ship = Ship::new(model, input.law)?;
    let speeds =
        input.trials.iter().flat_map(|trial| trial.channel(Channel::U).into_iter().flatten());
    ship.set_envelope_speed(speeds.fold(0.0, |most: f64, speed| most.max(speed.abs())));
    Ok(ship)
}

/// Trials in order of interest: held-out before fitted, kinds of manoeuvre in turn, and within a
/// kind first one from each half of the list, as similar names are neighbours.
fn ranked_trials<'a>(input: &RefinementInput<'a>) -> Vec<&'a Trial> {
    let mut kinds: BTreeMap<(bool, ManoeuvreKind), Vec<&Trial>> = BTreeMap::new();
    for trial in input.trials {
        kinds
            .entry((is_fitted(input, trial), ManoeuvreKind::from_trial(trial)))
            .or_default()
            .push(trial);
    }
    let mut keyed: Vec<((bool, usize, ManoeuvreKind), &Trial)> = Vec::new();
    for ((fitted, kind), trials) in kinds {
        keyed.extend(
            middle_second(trials)
                .into_iter()
                .enumerate()
                .map(|(turn, trial)| ((fitted, turn, kind), trial)),
        );
    }
    // Held-out trials first, then the first trial of each kind, the second of each kind, and so on.
    keyed.sort_by_key(|(key, _)| *key);
    keyed.into_iter().map(|(_, trial)| trial).collect()
}

/// Moves the middle trial to the second place.
fn middle_second(mut trials: Vec<&Trial>) -> Vec<&Trial> {
    if trials.len() > 2 {
        let middle = trials.remove(trials.len() / 2);
        trials.insert(1, middle);
    }
    trials
}

/// Kind of manoeuvre, by the trial's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum ManoeuvreKind {
    Zigzag,
    Turn,
    Other,
}

impl ManoeuvreKind {
    fn from_trial(trial: &Trial) -> Self {
        let text =
            format!("{} {}", trial.manoeuvre.as_deref().unwrap_or(""), trial.name).to_lowercase();
        // The name of the trial is the only hint if no manoeuvre is stated.
        if text.contains("zigzag") || text.contains("zig-zag") || text.contains("zz") {
            Self::Zigzag
        } else if text.contains("turn") || text.contains("circle") {
            Self::Turn
        } else {
            Self::Other
        }
    }
}
