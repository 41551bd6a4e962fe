//! Simulation of a recorded trial, and its errors.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::Serialize;
use sistership_model::trial::{Channel, Trial};
use sistership_model::validity::Excursion;
use sistership_model::{Law, Model};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, TrialReplay, replay_trial};

use crate::commands;
use crate::failure::Failure;
use crate::output::print_note;
use crate::table::{format_number, format_optional};
use crate::trials::ReadTrial;

/// Channels whose errors are in every document, null if unknown.
const CHANNELS: [Channel; 6] =
    [Channel::U, Channel::V, Channel::R, Channel::Psi, Channel::X, Channel::Y];

/// Errors of one trial as the `simulate` command prints them.
#[derive(Debug, Clone, Serialize)]
pub struct SimulatedTrial {
    /// The file as given in the call or the manifest.
    pub file: String,
    /// Time from the first to the last sample, s.
    pub duration_s: f64,
    /// Root mean square errors by channel, SI; null if the trial lacks the channel or the
    /// simulation diverged.
    pub rmse: BTreeMap<&'static str, Option<f64>>,
    /// Standardised mean squared error; null if the simulation diverged.
    pub standardised_mse: Option<f64>,
    /// True if the simulation left the physical range.
    pub diverged: bool,
    /// Time and reason of the divergence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Excursion outside the range covered by the model's trials, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outside: Option<Excursion>,
    /// Mean share of the learned correction over the simulation, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub branch_share: Option<f64>,
    /// The file of simulated states.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub out: Option<String>,
    #[serde(skip)]
    samples: usize,
}

/// Common parts of the simulations of all trials.
pub struct TrialSimulator<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
    /// Settings of the simulation.
    pub settings: ReplaySettings,
    /// Standard deviations of the channels over all trials.
    pub deviations: BTreeMap<Channel, f64>,
}

impl TrialSimulator<'_> {
    /// Simulates a trial.
    ///
    /// # Errors
    /// Returns an error if the model cannot be simulated, or if the trial lacks a channel.
    pub fn simulate_trial(
        &self,
        read: &ReadTrial,
    ) -> Result<(SimulatedTrial, TrialReplay), Failure> {
        let ship = self.prepare_ship(&read.trial)?;
        let run = replay_trial(&ship, &self.with_revolutions(&read.trial), &self.settings);
        let run = run.map_err(|error| {
            Failure::Refused(format!("{error} of {} by law `{}`", self.model.name, self.law.name))
        })?;
        let errors = self.trial_errors(&read.file, &read.trial, &run);
        Ok((SimulatedTrial { branch_share: ship.mean_correction_share(&run.track), ..errors }, run))
    }

    /// Returns the ship with a physical range that covers the speeds of a trial; its water depth is
    /// an input that the replay reads.
    fn prepare_ship(&self, trial: &Trial) -> Result<Ship, Failure> {
        let mut ship = commands::build_ship(self.model, self.law)?;
        let speeds = trial.channel(Channel::U).into_iter().flatten();
        ship.set_envelope_speed(speeds.fold(0.0_f64, |fastest, speed| fastest.max(speed.abs())));
        match trial.depth_m.or_else(|| mean_value(trial.channel(Channel::Depth)?)) {
            // The mean of a recorded depth is enough to see whether the ship floats.
            Some(depth_m) if commands::has_depth_input(self.law) => {
                commands::check_floats(self.model, depth_m)?
            }
            Some(depth_m) => {
                let law = &self.law.name;
                print_note(&format!(
                    "warning: {}: recorded in a water depth of {depth_m} m; law `{law}` is for \
                     deep water only",
                    trial.name
                ));
            }
            None => {}
        }
        Ok(ship)
    }

    /// Returns a trial with the model's own revolutions if none were recorded.
    fn with_revolutions<'t>(&self, trial: &'t Trial) -> Cow<'t, Trial> {
        let is_recorded = Channel::SHAFTS.iter().any(|&shaft| trial.channel(shaft).is_some());
        // A law with a default of its own needs none.
        let input = self.law.inputs.get(Channel::N.name()).filter(|input| input.default.is_none());
        let Some(n_rps) = self.model.revolutions_rps.filter(|_| !is_recorded && input.is_some())
        else {
            return Cow::Borrowed(trial);
        };
        print_note(&format!(
            "warning: {}: no revolutions are recorded; those of the model's approach, {n_rps:.3} \
             1/s, are taken",
            trial.name
        ));
        let mut trial = trial.clone();
        trial.channels.insert(Channel::N, vec![n_rps; trial.len()]);
        Cow::Owned(trial)
    }

    fn trial_errors(&self, file: &str, trial: &Trial, run: &TrialReplay) -> SimulatedTrial {
        let error = SquaredError::from_trial(trial, run);
        let reason = run.stopped.as_ref().map(ToString::to_string);
        // Errors until a divergence would look better than those of a complete simulation.
        let known = |value: Option<f64>| value.filter(|_| reason.is_none());
        let rmse = CHANNELS.map(|channel| (channel.name(), known(error.channel_rmse(channel))));
        SimulatedTrial {
            file: file.to_owned(),
            duration_s: trial.duration_s(),
            rmse: rmse.into(),
            standardised_mse: known(Some(standardised_mse(&error, &self.deviations))),
            diverged: reason.is_some(),
            reason,
            outside: run.outside.clone(),
            branch_share: None,
            out: None,
            samples: run.samples.len(),
        }
    }
}

impl SimulatedTrial {
    /// Formats the errors as cells of the table.
    pub fn table_cells(&self) -> Vec<String> {
        let value = |channel: Channel| {
            let scale =
                // Angles are printed in degrees, JSON has SI.
                if matches!(channel, Channel::R | Channel::Psi) { 1_f64.to_degrees() } else { 1.0 };
            format_optional(
                self.rmse.get(channel.name()).copied().flatten().map(|value| value * scale),
            )
        };
        let mut cells = vec![self.file.clone(), format_number(self.duration_s)];
        cells.extend(CHANNELS.map(value));
        cells.push(format_optional(self.standardised_mse));
        cells
    }
}

/// Returns the errors over all samples of all trials; `None` if one diverged.
pub fn total_errors(trials: &[SimulatedTrial]) -> Option<SimulatedTrial> {
    if trials.iter().any(|trial| trial.diverged) {
        return None;
    }
    let mean = |of: &dyn Fn(&SimulatedTrial) -> Option<f64>| {
        // Mean squares are weighted with the number of samples, as if all trials were one.
        let pairs = trials.iter().filter_map(|trial| Some((of(trial)?, trial.samples as f64)));
        let (sum, samples) = pairs.fold((0.0, 0.0), |(sum, all), (value, samples)| {
            (sum + value * samples, all + samples)
        });
        (samples > 0.0).then(|| sum / samples)
    };
    let rmse = CHANNELS.map(|channel| {
        let square = |trial: &SimulatedTrial| {
            trial.rmse.get(channel.name()).copied().flatten().map(|rmse| rmse * rmse)
        };
        (channel.name(), mean(&square).map(f64::sqrt))
    });
    Some(SimulatedTrial {
        file: "all".to_owned(),
        duration_s: trials.iter().map(|trial| trial.duration_s).sum(),
        rmse: rmse.into(),
        standardised_mse: mean(&|trial| trial.standardised_mse),
        diverged: false,
        reason: None,
        outside: None,
        branch_share: mean(&|trial| trial.branch_share),
        out: None,
        samples: trials.iter().map(|trial| trial.samples).sum(),
    })
}

fn mean_value(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}
