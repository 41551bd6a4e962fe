//! Diagnosis of the residual: effects that a model lacks, if any.

mod as_recorded;
mod calibrate;
mod calibrated_model;
mod changes;
mod choose;
mod coefficient_prior;
mod confounded;
mod constancy;
mod continued_history;
mod corrected;
mod covariance;
mod dependence;
mod discount;
mod effect_history;
mod effect_size;
mod evidence;
mod expected;
mod filtered_base;
mod findings;
mod form_errors;
mod hidden_patterns;
mod hypothesis;
mod judge;
mod limits;
mod linearised_trials;
mod log_priors;
mod misfit;
mod next_trial;
mod nuisance;
mod origin;
mod outcome;
mod patterns;
mod placebo;
mod refit;
mod refusal;
mod remainder;
mod run;
mod screening;
mod search;
mod select;
mod sequence;
mod series;
mod settings;
mod setup;
mod thresholds;
mod values;

use std::sync::Arc;

pub use as_recorded::trial_from_track;
pub use calibrate::calibrate_model;
pub use effect_history::{EffectHistory, FormHistory};
pub use expected::{ExpectedInformation, TrialUnknowns, observable_forms};
pub use outcome::{
    ChangeCourse, ConfoundedEffect, DetectionLimit, Diagnosis, DiscrepancyLevel, EffectChange,
    HypothesisReport, LimitedBy, ManoeuvreOutcome, MissingEffect, NextTrial, OriginKind,
    RemainderDependence, RemainderOrigin, ResidualSeries, TrialErrors, UnexplainedSegment,
    ValueWithError, VariableDependence, Verdict,
};
pub use sequence::diagnose;
pub use settings::Settings;
use sistership_model::law::Law;
use sistership_model::{Effect, Model, Trial};

/// Model and trials of a diagnosis.
#[derive(Debug, Clone, Copy)]
pub struct DiagnosisInputs<'a> {
    /// The model, with the effects that it carries already.
    pub model: &'a Model,
    /// Its law, without effects.
    pub law: &'a Law,
    /// Library of effects.
    pub effects: &'a [Arc<Effect>],
    /// New trials of the ship, that the model was not fitted on.
    pub trials: &'a [&'a Trial],
    /// Settings.
    pub settings: &'a Settings,
}
