//! The problem of a refinement: everything that is constant while candidates are compared.

use std::collections::BTreeMap;

use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::vessel::Status;
use sistership_model::{Model, Vessel, particulars};
use sistership_simulation::error::standard_deviations;

use super::measure::PriorMeasure;
use super::progress::{FitIterate, IterateObserver};
use super::replayed_trials::ReplayedTrials;
use super::ridge::{CoefficientFit, FittedCoefficient};
use super::settings::RefinementSettings;

/// Inputs that are constant while candidates are compared.
pub(super) struct RefinementProblem<'a> {
    pub law: &'a Law,
    pub target: Option<&'a Vessel>,
    /// The source's name.
    pub source: &'a str,
    /// Trials that are fitted and held out, or parts of them.
    pub training: Vec<&'a Trial>,
    /// The same trials with the samples at which simulations are compared.
    pub replayed: ReplayedTrials,
    /// The whole trials of which `training` consists.
    pub whole: Vec<&'a Trial>,
    pub judged: Vec<&'a Trial>,
    /// Standard deviations of the channels over the training trials, which standardise errors.
    pub deviations: BTreeMap<Channel, f64>,
    pub transferred: Model,
    /// The source, transferred by its own law, where that has a propeller of its own.
    pub propeller: Option<(Model, &'a Law)>,
    /// Measure by which the prior weights coefficients.
    pub measure: PriorMeasure,
    pub settings: RefinementSettings,
    pub watch: Option<IterateObserver<'a>>,
}

impl<'a> RefinementProblem<'a> {
    /// Creates the problem of a model with itself as the source, on whole trials.
    pub fn from_model(
        model: &'a Model,
        law: &'a Law,
        trials: &[&'a Trial],
        settings: RefinementSettings,
    ) -> Self {
        let training = trials.to_vec();
        let (whole, judged, transferred) = (training.clone(), Vec::new(), model.clone());
        let lpp_m = particulars::particular_value(&model.particulars, "lpp_m");
        let replayed = ReplayedTrials::new(law, lpp_m, &training, settings.smoothing_s);
        let deviations = standard_deviations(&training);
        Self {
            law,
            target: None,
            source: &model.name,
            training,
            replayed,
            whole,
            judged,
            deviations,
            transferred,
            propeller: None,
            measure: PriorMeasure::Trials,
            settings,
            watch: None,
        }
    }

    /// Passes an iterate to the observer, if there is one.
    pub fn notify_observer(&self, iterate: &FitIterate<'_>) {
        self.watch.into_iter().for_each(|watch| watch(iterate));
    }

    /// Fold in which a training trial is held out.
    pub fn fold_of(&self, trial: usize) -> usize {
        trial % self.fold_count()
    }

    /// Number of folds: one a trial, or the settings' largest number.
    pub fn fold_count(&self) -> usize {
        self.training.len().min(self.settings.folds)
    }

    /// Returns true if a trial is fitted in a fold; a single trial is fitted and judged at once.
    pub fn is_fitted(&self, trial: usize, fold: usize) -> bool {
        self.training.len() == 1 || self.fold_of(trial) != fold
    }

    /// The shortest sampling interval, s.
    pub fn interval_s(&self) -> f64 {
        self.training.iter().map(|trial| trial.interval_s()).fold(f64::INFINITY, f64::min).max(1e-3)
    }

    /// Returns the transferred model with the coefficients and parameters of a fit.
    pub fn fitted_model(&self, fit: &CoefficientFit) -> Model {
        let mut model = self.model_with(&fit.coefficients);
        let all = fit.parameters.iter().map(|(name, one)| (name.clone(), self.refined(one)));
        model.parameters.extend(all);
        model
    }

    /// A fitted value as a quantity of a model.
    fn refined(&self, fitted: &FittedCoefficient) -> Quantity {
        Quantity {
            standard_error: Some(fitted.standard_error),
            ..Quantity::new(fitted.value, format!("refined from {}", self.source))
        }
    }

    /// Returns the transferred model with these coefficients and no others.
    pub fn model_with(&self, coefficients: &BTreeMap<String, FittedCoefficient>) -> Model {
        let mut model = self.transferred.clone();
        model.status = Status::Refined;
        let all = coefficients.iter().map(|(name, one)| (name.clone(), self.refined(one)));
        model.coefficients = all.collect();
        model
    }
}
