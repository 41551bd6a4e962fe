//! Error of a refinement on trials that it has not seen.

use std::sync::Arc;

use sistership_identification::refine::{
    EstimationMethod, RefinementSettings, RefinementSpec, refine,
};
use sistership_model::trial::Channel;
use sistership_model::{Law, Model, Trial, Vessel, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use crate::synthetic::replica;
use crate::truth::container::container;
use crate::truth::files::vessel;
use crate::truth::instruments::Instruments;
use crate::truth::manoeuvre::{Approach, Manoeuvre};
use crate::truth::motion::Truth;
use crate::truth::trials;

/// Source, law and ship of the refinements, and the trials that judge them.
pub struct RefinementJudge {
    source: Model,
    law: Arc<Law>,
    target: Vessel,
    unseen: Vec<Trial>,
}

const UNSEEN: [Manoeuvre; 3] =
    [Manoeuvre::Zigzag(15.0, 15.0), Manoeuvre::Turn(-15.0), Manoeuvre::Zigzag(-20.0, 10.0)];
const RECORDED: [Manoeuvre; 4] = [
    Manoeuvre::Turn(20.0),
    Manoeuvre::Zigzag(10.0, 10.0),
    Manoeuvre::Turn(-25.0),
    Manoeuvre::Zigzag(-20.0, 20.0),
];

/// Returns the trials of a container ship by a law that the zoo lacks, as instruments record them.
pub fn judge_trials(seed: u64) -> Vec<Trial> {
    trials(&container(), &RECORDED, &Instruments::SEA_TRIAL, seed)
}

/// Returns such trials with circles of 45 lengths, so that the turns become steady.
pub fn judge_circles(seed: u64) -> Vec<Trial> {
    let ship = container();
    let approach = Approach { speed: 1.0, lengths: 0.5 };
    let record = |(index, manoeuvre): (usize, &Manoeuvre)| {
        let lengths = if matches!(manoeuvre, Manoeuvre::Turn(_)) { 45.0 } else { 25.0 };
        let duration_s = lengths * ship.dimensions().length_time_s();
        let track = manoeuvre.sailed_for(&ship, approach, duration_s);
        let name = format!("{}.csv", manoeuvre.name());
        Instruments::SEA_TRIAL.record(&ship, &name, &track, &mut replica(seed, 100 + index))
    };
    RECORDED.iter().enumerate().map(record).collect()
}

impl RefinementJudge {
    /// Returns the judge of refinements of the Mariner's model for the container ship.
    ///
    /// # Panics
    /// The zoo cannot be read.
    pub fn new() -> Self {
        let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
        let source = zoo.find_model("mariner").unwrap_or_else(|error| panic!("{error}"));
        let law = zoo.law(&source.law).unwrap_or_else(|| panic!("no law")).clone();
        let ship = container();
        let target = Vessel::parse("ship.yaml", &vessel(ship.dimensions()))
            .unwrap_or_else(|error| panic!("{error}"));
        let unseen = trials(&ship, &UNSEEN, &Instruments::PERFECT, 9);
        Self { source, law, target, unseen }
    }

    /// Returns the error of a model refined on trials: its yaw rate on the unseen ones, deg/s;
    /// `None` without trials, or where it does not complete them.
    pub fn error_deg_s(&self, trials: &[Trial]) -> Option<f64> {
        Some(self.unseen_errors(trials, [Channel::R])?[0].to_degrees())
    }

    /// Returns the root mean square errors of channels on the unseen trials of a model refined on
    /// trials; `None` without trials, or where it does not complete them.
    pub fn unseen_errors<const N: usize>(
        &self,
        trials: &[Trial],
        channels: [Channel; N],
    ) -> Option<[f64; N]> {
        let trials: Vec<&Trial> = trials.iter().collect();
        let settings =
            RefinementSettings { method: EstimationMethod::Weak, ..RefinementSettings::default() };
        let request = RefinementSpec {
            target: &self.target,
            source: &self.source,
            source_law: None,
            law: &self.law,
            trials: &trials,
            population: &[],
            settings: &settings,
        };
        let refined = refine(&request, &|_, _| true).ok()?;
        let ship = Ship::new(&refined.model, &self.law).ok()?;
        let mut squares = [0.0; N];
        for trial in &self.unseen {
            let run = replay_trial(&ship, trial, &ReplaySettings::default()).ok()?;
            if run.stopped.is_some() {
                return None;
            }
            let error = SquaredError::from_trial(trial, &run);
            for (sum, channel) in squares.iter_mut().zip(channels) {
                *sum += error.channel_rmse(channel)?.powi(2);
            }
        }
        Some(squares.map(|sum| (sum / self.unseen.len() as f64).sqrt()))
    }
}

impl Default for RefinementJudge {
    fn default() -> Self {
        Self::new()
    }
}
