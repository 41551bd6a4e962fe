//! The whole refinement: tuning ranges widen from the source outwards, each gives an option, and the option whose
//! simulations of manoeuvres left out are best is taken.

use rayon::prelude::*;
use sistership_dynamics::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_dynamics::recorded::{ReplaySettings, replay};
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Trial;
use sistership_model::vessel::Status;
use sistership_model::{Model, Vessel};

use super::blocks::Blocks;
use super::outcome::{RefineError, Refinement, StepOption};
use super::published::{Choices, Fitted, Fold, tune};
use super::rows::trial_moments;
use super::settings::{Method, Settings};
use super::weak::{Windows, weak_moments};
use crate::regression::Moments;
use crate::transfer::{approach_of, ready, transfer};

/// What is to be refined, and against what.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The ship.
    pub target: &'a Vessel,
    /// The source model, as published or as refined earlier.
    pub source: &'a Model,
    /// The source's law.
    pub law: &'a Law,
    /// Her trials.
    pub trials: &'a [&'a Trial],
    /// Settings.
    pub settings: &'a Settings,
}

/// Told how far a refinement is (0 to 1) and what it does; answers `false` to stop it.
pub type Progress<'a> = &'a (dyn Fn(f64, &str) -> bool + Sync);

/// Refines a source model against trials.
///
/// # Errors
/// Says which setting, trial or channel is at fault; never leaves a model half refined.
pub fn refine(request: &Request<'_>, progress: Progress<'_>) -> Result<Refinement, RefineError> {
    request.settings.check().map_err(|(field, message)| RefineError::Setting { field, message })?;
    let task = Task::new(request)?;
    step(progress, 0.05, "sufficient statistics of each trial")?;
    let moments = task.moments()?;
    let folds = task.folds(&moments)?;
    let options = task.options(&folds, progress)?;
    step(progress, 0.8, "fitting all trials")?;
    let all = merged(&moments, |_| true).ok_or_else(|| RefineError::Data("the trials have no sample".into()))?;
    task.finish(options, &all, progress)
}

pub(super) fn step(progress: Progress<'_>, fraction: f64, what: &str) -> Result<(), RefineError> {
    if progress(fraction, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

/// A request with everything that does not change while options are tried.
pub(super) struct Task<'a> {
    pub(super) request: &'a Request<'a>,
    pub(super) training: Vec<&'a Trial>,
    pub(super) judged: Vec<&'a Trial>,
    pub(super) transferred: Model,
    pub(super) blocks: Blocks,
    pub(super) settings: Settings,
}

/// An option with what it takes to compare and to take it.
pub(super) struct Trying {
    pub(super) option: StepOption,
    pub(super) choices: Option<Choices>,
    pub(super) errors: SquaredError,
}

impl<'a> Task<'a> {
    fn new(request: &'a Request<'a>) -> Result<Self, RefineError> {
        let names = &request.settings.held_out;
        if let Some(unknown) = names.iter().find(|name| !request.trials.iter().any(|trial| trial.name == **name)) {
            let message = format!("no trial is called `{unknown}`");
            return Err(RefineError::Setting { field: "held_out".into(), message });
        }
        let (judged, training): (Vec<&Trial>, Vec<&Trial>) = request.trials.iter().partition(|trial| names.contains(&trial.name));
        if training.is_empty() {
            return Err(RefineError::Data("there is no trial to fit on".into()));
        }
        let transferred = if request.source.ship == request.target.name() {
            request.source.clone()
        } else {
            transfer(request.source, request.law, request.target, approach_of(&training))
        };
        let blocks = Blocks::new(&transferred, request.law)?;
        let settings = resolved(request, &training);
        Ok(Self { request, training, judged, transferred, blocks, settings })
    }

    fn moments(&self) -> Result<Vec<Vec<Moments>>, RefineError> {
        let one = |trial: &&Trial| match (self.settings.method, self.windows()) {
            (Method::Published, _) | (_, None) => trial_moments(&self.blocks, trial, self.settings.difference_s),
            (_, Some(windows)) => weak_moments(&self.blocks, trial, windows),
        };
        let moments: Vec<Vec<Moments>> = self.training.par_iter().map(one).collect::<Result<_, _>>()?;
        let samples: f64 = moments.iter().map(|m| m.first().map_or(0.0, |m| m.count)).sum();
        let widest = self.blocks.blocks.iter().map(super::Block::regressors).max().unwrap_or(0) as f64;
        if samples < 4.0 * widest {
            let message =
                format!("{samples} samples are too few for {widest} coefficients an axis; give at least {}", 4.0 * widest);
            return Err(RefineError::Data(message));
        }
        Ok(moments)
    }

    /// The windows of the weak form; none where neither the settings nor the ship's length and speed say how long.
    fn windows(&self) -> Option<Windows> {
        let length_s = self.settings.window_s?;
        Some(Windows { length_s, hop_s: self.settings.hop_s.unwrap_or(0.1 * length_s) })
    }

    /// Which fold a training trial is left out in.
    fn fold_of(&self, trial: usize) -> usize {
        trial % self.fold_count()
    }

    pub(super) fn fold_count(&self) -> usize {
        self.training.len().min(self.request.settings.folds)
    }

    /// Training sets with whole manoeuvres left out; a single trial can only judge itself.
    fn folds<'f>(&'f self, moments: &[Vec<Moments>]) -> Result<Vec<Fold<'f>>, RefineError> {
        let nothing = || RefineError::Data("a fold has no sample".into());
        let one = |fold: usize| {
            let inside = |trial: usize| self.training.len() == 1 || self.fold_of(trial) != fold;
            let training = merged(moments, inside).ok_or_else(nothing)?;
            let left_out = merged(moments, |trial| self.fold_of(trial) == fold).ok_or_else(nothing)?;
            Ok(Fold::new(&self.blocks, &self.transferred, &training, &left_out))
        };
        (0..self.fold_count()).map(one).collect()
    }

    /// The source itself, and one option for each range; a single trial allows the first range only.
    fn options(&self, folds: &[Fold<'_>], progress: Progress<'_>) -> Result<Vec<Trying>, RefineError> {
        let mut options = vec![self.source_option()?];
        let ranges = &self.request.settings.ranges;
        let allowed = if self.training.len() == 1 { 1 } else { ranges.len() };
        for (index, range) in ranges.iter().take(allowed).enumerate() {
            let done = 0.1 + 0.7 * index as f64 / allowed as f64;
            step(progress, done, &format!("lambda from {:.0e}: simulating manoeuvres left out", range.lambda_min))?;
            let choices = tune(folds, range, self.request.settings.lambda_count);
            options.push(self.ranged_option(index + 1, range.lambda_min, choices, folds)?);
        }
        Ok(options)
    }

    fn source_option(&self) -> Result<Trying, RefineError> {
        let (errors, reason) = self.simulate_all(&self.training, &|_| self.transferred.clone())?;
        Ok(self.trying("source".into(), None, None, errors, reason))
    }

    fn ranged_option(&self, number: usize, lambda_min: f64, choices: Choices, folds: &[Fold<'_>]) -> Result<Trying, RefineError> {
        let models: Vec<Model> = folds.iter().map(|fold| self.model_with(&fold.solve(&choices))).collect();
        let (errors, reason) = self.simulate_all(&self.training, &|trial| models[self.fold_of(trial)].clone())?;
        Ok(self.trying(number.to_string(), Some(lambda_min), Some(choices), errors, reason))
    }

    fn trying(
        &self,
        step: String,
        lambda_min: Option<f64>,
        choices: Option<Choices>,
        errors: SquaredError,
        reason: Option<String>,
    ) -> Trying {
        let error = reason.is_none().then(|| standardised_mse(&errors, &standard_deviations(&self.training)));
        let flat = |of: &dyn Fn(&crate::regression::Choice) -> f64| choices.iter().flatten().flatten().map(of).collect();
        let (lambda, alpha) = (flat(&|c| c.lambda), flat(&|c| c.alpha));
        Trying { option: StepOption { step, lambda_min, lambda, alpha, error, chosen: false, reason }, choices, errors }
    }

    /// Simulates trials, each with the model that did not see it; the first divergence is the reason against the option.
    pub(super) fn simulate_all(
        &self,
        trials: &[&Trial],
        model_of: &(dyn Fn(usize) -> Model + Sync),
    ) -> Result<(SquaredError, Option<String>), RefineError> {
        let settings = ReplaySettings { restart_s: self.settings.restart_s, ..ReplaySettings::default() };
        let one = |(index, trial): (usize, &&Trial)| -> Result<(SquaredError, Option<String>), RefineError> {
            let ship = match ready(&model_of(index), self.request.law, trials) {
                Ok(ship) => ship,
                Err(reason) => return Ok((SquaredError::default(), Some(reason))),
            };
            let run = replay(&ship, trial, &settings).map_err(|e| RefineError::Channel { trial: e.trial, channel: e.channel })?;
            let reason = run.stopped.as_ref().map(|stopped| format!("{} {stopped}", trial.name));
            Ok((SquaredError::of(trial, &run), reason))
        };
        let each: Vec<_> = trials.par_iter().enumerate().map(one).collect::<Result<_, _>>()?;
        let mut total = SquaredError::default();
        each.iter().for_each(|(error, _)| total.add(error));
        Ok((total, each.into_iter().find_map(|(_, reason)| reason)))
    }

    /// The transferred model with other coefficients.
    pub(super) fn model_with(&self, coefficients: &std::collections::BTreeMap<String, Fitted>) -> Model {
        let mut model = self.transferred.clone();
        model.status = Status::Refined;
        for (name, fitted) in coefficients {
            let quantity = Quantity {
                standard_error: Some(fitted.standard_error),
                ..Quantity::new(fitted.value, format!("refined from {}", self.request.source.name))
            };
            model.coefficients.insert(name.clone(), quantity);
        }
        model
    }
}

/// The settings with the times that depend on the ship filled in, so that a version records what was used.
fn resolved(request: &Request<'_>, training: &[&Trial]) -> Settings {
    let length_s = request.target.particular("lpp_m").zip(approach_of(training)).map(|(l, approach)| l / approach.speed_m_s);
    let mut settings = request.settings.clone();
    if settings.method == Method::Published {
        settings.difference_s = settings.difference_s.or(length_s.map(|s| 0.1 * s));
    } else {
        settings.window_s = settings.window_s.or(length_s.map(|s| s / 1.5));
        settings.hop_s = settings.hop_s.or(settings.window_s.map(|s| 0.1 * s));
    }
    settings.restart_s = settings.restart_s.or(length_s.map(|s| 10.0 * s));
    settings
}

/// The statistics of some trials together, one set per regression.
fn merged(moments: &[Vec<Moments>], keep: impl Fn(usize) -> bool) -> Option<Vec<Moments>> {
    let kept: Vec<&Vec<Moments>> = moments.iter().enumerate().filter(|(trial, _)| keep(*trial)).map(|(_, m)| m).collect();
    let blocks = kept.first()?.len();
    (0..blocks).map(|block| Moments::sum(kept.iter().map(|m| &m[block]))).collect()
}
