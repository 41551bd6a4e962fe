//! Check of a fitted model: turns to both sides at every angle of its steering gear, and zigzags,
//! stay within the physical range.

use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::manoeuvre::{
    Manoeuvre, ManoeuvreSettings, StandardManoeuvres, simulate_manoeuvre_batch,
};
use sistership_simulation::{Ship, SimulationStop};

use super::thresholds::RANGE_CHECK;

/// Manoeuvres in which a model leaves the physical range, in words.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct RangeFaults {
    /// The first with a rudder angle that its trials reach.
    pub within: Option<String>,
    /// The first with a larger one, or a standard manoeuvre.
    pub beyond: Option<String>,
}

impl RangeFaults {
    /// Simulates turns and zigzags of a model; `standard` are its standard manoeuvres. A model that
    /// cannot be set up fails all of them.
    pub fn simulate(
        model: &Model,
        law: &Law,
        trials: &[&Trial],
        standard: &StandardManoeuvres,
    ) -> Self {
        let covered_deg = covered_angle_deg(trials).unwrap_or(model.steering.limit_deg);
        let beyond = standard.failures.first().cloned();
        let ship = match Ship::new(model, law) {
            Ok(ship) => ship,
            Err(error) => return Self { within: Some(error.to_string()), beyond },
        };
        // Both sides and all angles: a model may turn well at the angles of its trials and leave the
        // range between them.
        let failed = failed_manoeuvres(&ship, model.steering.limit_deg);
        let is_within = |(rudder_deg, _): &&(f64, String)| {
            // Recorded angles are those of an order within the resolution of the check.
            rudder_deg.abs() <= covered_deg + 0.5 * RANGE_CHECK.turn_step_deg
        };
        let reason = |(_, reason): &(f64, String)| reason.clone();
        Self {
            within: failed.iter().find(is_within).map(reason),
            beyond: failed.iter().find(|one| !is_within(one)).map(reason).or(beyond),
        }
    }

    /// The first of them, those within first.
    pub fn first(&self) -> Option<String> {
        self.within.clone().or_else(|| self.beyond.clone())
    }
}

/// Largest rudder angle of the trials, deg; `None` if none was recorded.
fn covered_angle_deg(trials: &[&Trial]) -> Option<f64> {
    let recorded = trials.iter().filter_map(|trial| trial.channel(Channel::Delta)).flatten();
    recorded.map(|delta_rad| delta_rad.abs().to_degrees()).reduce(f64::max)
}

/// Rudder angle, deg, and reason of each manoeuvre that leaves the physical range.
fn failed_manoeuvres(ship: &Ship, limit_deg: f64) -> Vec<(f64, String)> {
    let step_s = RANGE_CHECK.step * ship.lpp_m() / ship.approach_speed_m_s();
    // Turns end after three circles, or after 60 ship lengths' time.
    let settings = ManoeuvreSettings { step_s: Some(step_s), ..ManoeuvreSettings::default() };
    let steered = steered_manoeuvres(limit_deg);
    let asked: Vec<(Manoeuvre, &[f64])> =
        steered.iter().map(|manoeuvre| (*manoeuvre, &[][..])).collect();
    let outcomes = simulate_manoeuvre_batch(ship, &asked, &settings).into_iter();
    let failure = |(manoeuvre, outcome): (&Manoeuvre, Result<_, SimulationStop>)| {
        let (Manoeuvre::Turn { rudder } | Manoeuvre::Zigzag { rudder, .. }) = *manoeuvre;
        Some((rudder, format!("{manoeuvre}: {}", outcome.err()?)))
    };
    steered.iter().zip(outcomes).filter_map(failure).collect()
}

/// Turns at evenly spaced angles, the last of which is the gear's limit, and zigzags at every few of
/// them; to both sides.
fn steered_manoeuvres(limit_deg: f64) -> Vec<Manoeuvre> {
    let count = (limit_deg / RANGE_CHECK.turn_step_deg).round().max(1.0) as usize;
    let angle = |k: usize| limit_deg * k as f64 / count as f64;
    let turns = (1..=count).map(|k| Manoeuvre::Turn { rudder: angle(k) });
    let zigzags = (RANGE_CHECK.every..=count)
        .step_by(RANGE_CHECK.every)
        .map(|k| Manoeuvre::Zigzag { rudder: angle(k), switch: angle(k) });
    let other_side = |manoeuvre| match manoeuvre {
        Manoeuvre::Turn { rudder } => Manoeuvre::Turn { rudder: -rudder },
        Manoeuvre::Zigzag { rudder, switch } => Manoeuvre::Zigzag { rudder: -rudder, switch },
    };
    turns.chain(zigzags).flat_map(|manoeuvre| [manoeuvre, other_side(manoeuvre)]).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::testing::{mariner_model, simulated_trials, with_scaled_coefficients};

    #[test]
    fn a_turn_between_the_standard_ones_is_found() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let trials: Vec<&Trial> = trials.iter().collect();
        let standard = StandardManoeuvres::default();
        let faults = |model: &Model| RangeFaults::simulate(model, &law, &trials, &standard);
        assert_eq!(faults(&model), RangeFaults::default());
        let runs_away =
            with_scaled_coefficients(&model, |name| if name == "N_r" { -10.0 } else { 1.0 });
        let found = faults(&runs_away).within.unwrap();
        assert!(found.starts_with("turn 2.5 deg: stopped at "), "{found}");
    }

    #[test]
    fn angles_beyond_those_of_the_trials_are_told_from_those_within() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let least: Vec<&Trial> = trials.iter().take(1).collect();
        assert!((covered_angle_deg(&least).unwrap() - 10.0).abs() < 0.5);
        let standard = StandardManoeuvres {
            failures: vec!["turn 35 deg: stopped".into()],
            ..StandardManoeuvres::default()
        };
        let found = RangeFaults::simulate(&model, &law, &least, &standard);
        assert_eq!((found.within, found.beyond.unwrap().as_str()), (None, "turn 35 deg: stopped"));
    }
}
