//! The whole refinement: tuning ranges widen from the source outwards, each gives an option, and the option whose
//! simulations of manoeuvres left out are best is taken.

use std::collections::BTreeMap;

use sistership_dynamics::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Trial;
use sistership_model::vessel::Status;
use sistership_model::{Model, Vessel, particulars};

use super::across::{self, Imitation};
use super::blocks::Blocks;
use super::cma_es::SearchReport;
use super::measure::Measure;
use super::outcome::{RefineError, Refinement, StepOption};
use super::parts::parts;
use super::published::{Choices, Fit, Fitted, Fold, tune};
use super::settings::{Method, Settings};
use super::simulated::Simulated;
use super::thinned::thinned;
use super::trajectory::Bend;
use super::variant::Variant;
use crate::transfer::{approach_of, transfer};

/// What is to be refined, and against what.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The ship.
    pub target: &'a Vessel,
    /// The source model, as published or as refined earlier.
    pub source: &'a Model,
    /// The source's law where it is another than what is fitted: what it says becomes the prior.
    pub source_law: Option<&'a Law>,
    /// The law of what is fitted.
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
    refine_watched(request, progress, &|_| ())
}

/// What the fit on all trials passes by on its way: for learning curves.
pub struct Glimpse<'a> {
    /// Simulations of all trials so far, by a search; 0 for the trajectory form, which does not count them.
    pub evaluations: usize,
    /// What the estimator makes least, so far; each estimator has its own.
    pub objective: f64,
    /// The model that it would give if it ended here.
    pub model: &'a dyn Fn() -> Model,
}

/// Shown what a fit passes by.
pub type Watch<'a> = &'a (dyn Fn(&Glimpse<'_>) + Sync);

/// As [`refine`], and shows what `trajectory` and `cma-es` pass by.
///
/// # Errors
/// As [`refine`].
pub fn refine_watched(request: &Request<'_>, progress: Progress<'_>, watch: Watch<'_>) -> Result<Refinement, RefineError> {
    request.settings.check().map_err(|(field, message)| RefineError::Setting { field, message })?;
    let (judged, whole) = divided(request)?;
    let settings = resolved(request.settings, request.target.particular("lpp_m"), &whole);
    let parts = parts(&whole, request.law, &settings);
    let (transferred, measure) = starting(request, &whole, !parts.is_empty())?;
    let training = if parts.is_empty() { whole.clone() } else { parts.iter().collect() };
    let (law, source, watch) = (request.law, request.source.name.as_str(), Some(watch));
    let thinned = fewer(request.target.particular("lpp_m"), &training);
    let task = Task { law, source, training, thinned, whole, judged, transferred, measure, settings, watch };
    step(progress, 0.05, "sufficient statistics of each trial")?;
    let variants = task.variants()?;
    let mut options = task.options(&variants, progress)?;
    if task.settings.method == Method::Trajectory {
        task.by_trajectory(&variants, &mut options, progress)?;
    }
    if task.settings.method == Method::CmaEs {
        task.by_cma_es(&variants, &mut options, progress)?;
    }
    step(progress, 0.8, "fitting all trials")?;
    task.finish(options, &variants, progress)
}

pub(super) fn step(progress: Progress<'_>, fraction: f64, what: &str) -> Result<(), RefineError> {
    if progress(fraction, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

/// Told how far the options of a family are, and what is tried.
type Told<'a> = &'a dyn Fn(f64, &str) -> Result<(), RefineError>;

/// A request with everything that does not change while options are tried.
pub(super) struct Task<'a> {
    pub(super) law: &'a Law,
    /// The source's name.
    pub(super) source: &'a str,
    /// What is fitted and left out: the trials, or parts of them.
    pub(super) training: Vec<&'a Trial>,
    /// The same with no more samples than a simulation needs.
    pub(super) thinned: Vec<Trial>,
    /// The trials of which that is.
    pub(super) whole: Vec<&'a Trial>,
    pub(super) judged: Vec<&'a Trial>,
    pub(super) transferred: Model,
    /// What the prior measures coefficients by.
    pub(super) measure: Measure,
    pub(super) settings: Settings,
    watch: Option<Watch<'a>>,
}

/// What an option takes.
pub(super) enum Taken {
    /// The source as it is.
    Source,
    /// A ridge of a variant at its choices.
    Ridge { variant: usize, choices: Choices },
    /// Where the trajectory form comes to on all trials.
    Reached(Box<Bend>),
    /// What the search finds on all trials.
    Found(Box<Fit>),
}

/// An option with what it takes to compare and to take it.
pub(super) struct Trying {
    pub(super) option: StepOption,
    pub(super) taken: Taken,
    pub(super) errors: SquaredError,
    /// Standardised errors by trial.
    pub(super) each: Vec<f64>,
    /// Number of coefficients that are fitted.
    pub(super) size: usize,
    /// The model of each fold, which did not see it; none of the source.
    pub(super) left_out: Vec<Model>,
    /// What a search did.
    pub(super) search: Option<SearchReport>,
}

impl<'a> Task<'a> {
    /// Of a model with itself as the source, on whole trials.
    pub(super) fn of_model(model: &'a Model, law: &'a Law, trials: &[&'a Trial], settings: Settings) -> Self {
        let training = trials.to_vec();
        let (whole, judged, transferred) = (training.clone(), Vec::new(), model.clone());
        let thinned = fewer(particulars::value(&model.particulars, "lpp_m"), &training);
        Self {
            law,
            source: &model.name,
            training,
            thinned,
            whole,
            judged,
            transferred,
            measure: Measure::Trials,
            settings,
            watch: None,
        }
    }

    /// Shows what a fit passes by to whoever watches.
    pub(super) fn glimpse(&self, glimpse: &Glimpse<'_>) {
        self.watch.into_iter().for_each(|watch| watch(glimpse));
    }

    /// Which fold a training trial is left out in.
    pub(super) fn fold_of(&self, trial: usize) -> usize {
        trial % self.fold_count()
    }

    pub(super) fn fold_count(&self) -> usize {
        self.training.len().min(self.settings.folds)
    }

    /// The source itself, and options from it outwards for each family of terms.
    pub(super) fn options(&self, variants: &[Variant], progress: Progress<'_>) -> Result<Vec<Trying>, RefineError> {
        let mut options = vec![self.source_option(variants)?];
        for (index, variant) in variants.iter().enumerate() {
            let folds = self.folds(variant)?;
            let share = 0.7 / variants.len() as f64;
            let told = |done: f64, what: &str| step(progress, 0.1 + share * (index as f64 + done), what);
            match self.settings.method {
                Method::Published => self.by_range(index, variant, &folds, &told, &mut options)?,
                // The search alone is weighed against the source.
                Method::CmaEs => {}
                _ => self.by_strength(index, variant, &folds, &told, &mut options)?,
            }
        }
        Ok(options)
    }

    /// One option for each range; a single trial allows the first range only.
    fn by_range(
        &self,
        at: usize,
        variant: &Variant,
        folds: &[Fold<'_>],
        told: Told<'_>,
        options: &mut Vec<Trying>,
    ) -> Result<(), RefineError> {
        let ranges = &self.settings.ranges;
        let allowed = if self.training.len() == 1 { 1 } else { ranges.len() };
        for (index, range) in ranges.iter().take(allowed).enumerate() {
            let what = format!("lambda from {:.0e}: simulating manoeuvres left out", range.lambda_min);
            told(index as f64 / allowed as f64, &what)?;
            let choices = tune(folds, range, self.settings.lambda_count);
            let taken = Taken::Ridge { variant: at, choices };
            options.push(self.ridge_option((index + 1).to_string(), range.lambda_min, taken, variant, folds)?);
        }
        Ok(())
    }

    /// One option for each strength of the prior, from the source outwards; a single trial allows the first three only.
    fn by_strength(
        &self,
        index: usize,
        variant: &Variant,
        folds: &[Fold<'_>],
        told: Told<'_>,
        options: &mut Vec<Trying>,
    ) -> Result<(), RefineError> {
        let strengths = &self.settings.strengths;
        let allowed = if self.training.len() == 1 { strengths.len().min(3) } else { strengths.len() };
        for (k, &lambda) in strengths.iter().take(allowed).enumerate() {
            let label = format!("{}, lambda {lambda:.0e}", variant.family.name());
            told(k as f64 / allowed as f64, &format!("{label}: simulating manoeuvres left out"))?;
            let choices = self.common_choices(variant, lambda)?;
            options.push(self.ridge_option(label, lambda, Taken::Ridge { variant: index, choices }, variant, folds)?);
        }
        Ok(())
    }

    /// The source as it is, where it keeps what the settings ask of a model.
    fn source_option(&self, variants: &[Variant]) -> Result<Trying, RefineError> {
        let limits = variants.iter().find_map(|variant| variant.limits.as_ref());
        if let Some(Err(reason)) = limits.map(|limits| limits.check(&self.transferred)) {
            return Ok(self.trying("source".into(), None, Taken::Source, 0, Simulated::refused(reason)));
        }
        let simulated = self.simulate_training(std::slice::from_ref(&self.transferred), &|_| 0)?;
        Ok(self.trying("source".into(), None, Taken::Source, 0, simulated))
    }

    fn ridge_option(
        &self,
        label: String,
        lambda_min: f64,
        taken: Taken,
        variant: &Variant,
        folds: &[Fold<'_>],
    ) -> Result<Trying, RefineError> {
        let Taken::Ridge { choices, .. } = &taken else { return Err(RefineError::Law("no ridge".into())) };
        let model = |fold: &Fold<'_>| Ok(self.model_with(&variant.solve(fold, choices)?));
        let models: Vec<Model> = match folds.iter().map(model).collect::<Result<_, String>>() {
            Ok(models) => models,
            Err(reason) => return Ok(self.trying(label, Some(lambda_min), taken, 0, Simulated::refused(reason))),
        };
        let simulated = self.simulate_training(&models, &|trial| self.fold_of(trial))?;
        let size = models.first().map_or(0, |model| model.coefficients.len());
        Ok(Trying { left_out: models, ..self.trying(label, Some(lambda_min), taken, size, simulated) })
    }

    pub(super) fn trying(
        &self,
        step: String,
        lambda_min: Option<f64>,
        taken: Taken,
        size: usize,
        simulated: Simulated,
    ) -> Trying {
        let deviations = standard_deviations(&self.training);
        let Simulated { total: errors, each, reason } = simulated;
        let error = reason.is_none().then(|| standardised_mse(&errors, &deviations));
        let each = each.iter().map(|error| standardised_mse(error, &deviations)).collect();
        let flat = |of: &dyn Fn(&crate::regression::Choice) -> f64| {
            taken.choices().iter().flat_map(|choices| choices.iter().flatten()).map(of).collect()
        };
        let (lambda, alpha) = (flat(&|c| c.lambda), flat(&|c| c.alpha));
        let option = StepOption { step, lambda_min, lambda, alpha, error, chosen: false, reason };
        Trying { option, taken, errors, each, size, left_out: Vec::new(), search: None }
    }

    /// The transferred model with these coefficients and no others.
    pub(super) fn model_with(&self, coefficients: &BTreeMap<String, Fitted>) -> Model {
        let mut model = self.transferred.clone();
        model.status = Status::Refined;
        model.coefficients.clear();
        for (name, fitted) in coefficients {
            let quantity = Quantity {
                standard_error: Some(fitted.standard_error),
                ..Quantity::new(fitted.value, format!("refined from {}", self.source))
            };
            model.coefficients.insert(name.clone(), quantity);
        }
        model
    }
}

impl Taken {
    fn choices(&self) -> Option<&Choices> {
        match self {
            Self::Ridge { choices, .. } => Some(choices),
            Self::Source | Self::Reached(_) | Self::Found(_) => None,
        }
    }
}

/// Trials with samples as far apart as a thirtieth of the time in which the ship sails her length.
fn fewer(lpp_m: Option<f64>, training: &[&Trial]) -> Vec<Trial> {
    let step_s = lpp_m.zip(approach_of(training)).map(|(l, approach)| l / approach.speed_m_s / 30.0);
    training.iter().map(|trial| thinned(trial, step_s)).collect()
}

/// What the prior is about: the source carried over, by its own law or as another law says what it says.
fn starting(request: &Request<'_>, whole: &[&Trial], in_parts: bool) -> Result<(Model, Measure), RefineError> {
    let Request { target, source, source_law, law, .. } = *request;
    let approach = approach_of(whole);
    let Some(own) = source_law.filter(|own| own.name != law.name) else {
        let same = source.ship == target.name();
        let carried = if same { source.clone() } else { transfer(source, law, target, approach) };
        let measure = Measure::own(&carried, law, whole, in_parts);
        return Ok((carried, measure));
    };
    let (mut model, envelope) = across::begun((source, own), law, target, approach, whole)?;
    let blocks = Blocks::new(&model, law)?;
    Imitation::new(&envelope, &blocks, &model)?.fill(&blocks, &mut model);
    Ok((model, Measure::Source(envelope)))
}

/// The trials that are kept out of fit and choice, and the others.
fn divided<'a>(request: &'a Request<'a>) -> Result<(Vec<&'a Trial>, Vec<&'a Trial>), RefineError> {
    let names = &request.settings.held_out;
    if let Some(unknown) = names.iter().find(|name| !request.trials.iter().any(|trial| trial.name == **name)) {
        let message = format!("no trial is called `{unknown}`");
        return Err(RefineError::Setting { field: "held_out".into(), message });
    }
    let (judged, whole): (Vec<&Trial>, Vec<&Trial>) = request.trials.iter().partition(|trial| names.contains(&trial.name));
    if whole.is_empty() {
        return Err(RefineError::Data("there is no trial to fit on".into()));
    }
    Ok((judged, whole))
}

/// The settings with the times that depend on the ship filled in, so that a version records what was used.
pub(super) fn resolved(settings: &Settings, lpp_m: Option<f64>, training: &[&Trial]) -> Settings {
    let length_s = lpp_m.zip(approach_of(training)).map(|(l, approach)| l / approach.speed_m_s);
    let mut settings = settings.clone();
    if settings.method == Method::Published {
        settings.difference_s = settings.difference_s.or(length_s.map(|s| 0.1 * s));
    } else {
        settings.window_s = settings.window_s.or(length_s);
        settings.hop_s = settings.hop_s.or(settings.window_s.map(|s| 0.1 * s));
        settings.fill_selection();
    }
    if settings.method == Method::CmaEs {
        // The paper's 0.1 s and 100 s, for a ship of 3 m at 0.4 m/s, or as long as this ship needs for as many lengths.
        settings.cma_es.get_or_insert_default();
        settings.step_s = settings.step_s.or(length_s.map(|s| s / 75.0));
        settings.segment_s = settings.segment_s.or(length_s.map(|s| (10.0 * s).max(100.0)));
    }
    if settings.method == Method::Trajectory {
        settings.step_s = settings.step_s.or(length_s.map(|s| s / 30.0));
        settings.segment_s = settings.segment_s.or(length_s.map(|s| 5.0 * s));
        settings.residual_s = settings.residual_s.or(length_s.map(|s| s / 7.5));
    }
    settings.restart_s = settings.restart_s.or(length_s.map(|s| 10.0 * s));
    settings
}
