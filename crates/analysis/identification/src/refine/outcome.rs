//! Results of a refinement, and the errors by which it is refused.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::trial::Channel;
use sistership_model::trial_input::MissingInput;
use sistership_simulation::PlantError;
use sistership_simulation::manoeuvre::{NamedFigure, StandardManoeuvres};
use sistership_simulation::metrics::ManoeuvreMetrics;

use super::cma_es::SearchReport;
use super::settings::RefinementSettings;
use crate::constraints::LimitError;
use sistership_assessment::course::CourseFigure;
use sistership_assessment::uncertainty::{UncertaintyBand, UncertaintyBands};
use sistership_priors::transfer::UnknownParameter;

/// The error type for a refinement that is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RefineError {
    /// The law's equations cannot be set up for the model.
    #[error(transparent)]
    Equations(#[from] PlantError),
    /// A trial lacks a channel.
    #[error("trial `{trial}` has no channel `{channel}`, which the law needs")]
    Channel {
        /// The trial.
        trial: String,
        /// The channel.
        channel: Channel,
    },
    /// The law cannot be used for this refinement.
    #[error("{0}")]
    Law(String),
    /// The data do not suffice for a fit.
    #[error("{0}")]
    Data(String),
    /// A setting is out of range.
    #[error("settings.{field}: {message}")]
    Setting {
        /// The setting.
        field: String,
        /// Values that are allowed.
        message: String,
    },
    /// Every option left the physical range or does not keep the constraints.
    #[error("no option can be selected: {0}")]
    Diverged(String),
    /// The constraints cannot be kept.
    #[error(transparent)]
    Constraints(#[from] LimitError),
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl RefineError {
    /// Returns the error that no option can be chosen, with each reason once.
    pub fn all_diverged<'a>(reasons: impl Iterator<Item = &'a str>) -> Self {
        Self::Diverged(join_distinct(reasons))
    }
}

/// Joins distinct reasons in their order; many options share one.
fn join_distinct<'a>(reasons: impl Iterator<Item = &'a str>) -> String {
    let mut told: Vec<&str> = Vec::new();
    for reason in reasons {
        if !told.contains(&reason) {
            told.push(reason);
        }
    }
    told.join("; ")
}

impl From<MissingInput> for RefineError {
    fn from(error: MissingInput) -> Self {
        match error {
            MissingInput::Channel { trial, channel } => Self::Channel { trial, channel },
            MissingInput::Unrecordable(_) => Self::Law(error.to_string()),
        }
    }
}

impl From<UnknownParameter> for RefineError {
    fn from(error: UnknownParameter) -> Self {
        Self::Law(error.to_string())
    }
}

/// Change of one coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoefficientChange {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The source's value.
    pub source: f64,
    /// The refined value.
    pub refined: f64,
    /// Posterior standard error.
    pub standard_error: f64,
    /// Distance from the source in standard deviations of the prior.
    pub moved_sd: f64,
}

impl CoefficientChange {
    /// Returns true if the standard error is no larger than the value; a value that is not so is
    /// the prior's, not the trials'.
    pub fn is_determined(&self) -> bool {
        self.standard_error <= self.refined.abs()
    }
}

/// One step of the widening ranges, with the errors that it gives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepOption {
    /// `source`, or the range's number from 1.
    pub step: String,
    /// Least lambda allowed; none for the source itself.
    pub lambda_min: Option<f64>,
    /// Chosen lambda by acceleration, in the order of the axes.
    pub lambda: Vec<f64>,
    /// Chosen alpha likewise.
    pub alpha: Vec<f64>,
    /// Standardised mean squared error of simulated held-out manoeuvres, the geometric mean over
    /// restart intervals; none if a simulation diverged at the shortest.
    pub error: Option<f64>,
    /// True if this option was chosen.
    pub chosen: bool,
    /// Reason why it could not be chosen, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl RefinementManoeuvres {
    /// Returns a sentence about the widest uncertainty band, if it is wide: that of an advance or
    /// tactical diameter is wide if it exceeds half the figure, that of a first overshoot if it
    /// exceeds the 10 deg between the least and the greatest value that MSC.137(76) allows.
    pub fn wide_band(&self) -> Option<String> {
        let bands = self.bands.as_ref()?;
        let width = |figure: &NamedFigure| {
            let allowed = allowed_width(figure)?;
            let band = bands.figure_band(&figure.name)?;
            // Widths relative to what is allowed make different units comparable.
            let width = (band.high - band.low) / allowed;
            (width > 1.0).then_some((width, band.clone()))
        };
        let figures = self.refined.list_figures();
        let wide = figures.iter().filter_map(width);
        let (_, band) = wide.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let UncertaintyBand { figure, unit, low, high, .. } = band;
        Some(format!(
            "The uncertainty is large: {figure} is between {low:.0} and {high:.0} {unit} (95 %)"
        ))
    }
}

/// Width from which on a figure's band is reported as wide; `None` for figures that are not judged
/// by it.
fn allowed_width(figure: &NamedFigure) -> Option<f64> {
    let is = |name: &str| figure.name.ends_with(name);
    if is("first overshoot") {
        return Some(10.0);
    }
    let turns = is("advance") || is("tactical diameter");
    figure.value.filter(|_| turns).map(|value| 0.5 * value.abs())
}

/// Root mean square errors by channel (SI) on held-out manoeuvres.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldOut {
    /// The transferred source model.
    pub source: BTreeMap<String, f64>,
    /// The refined model.
    pub refined: BTreeMap<String, f64>,
    /// Method by which the manoeuvres were held out.
    pub how: String,
}

/// The result of a refinement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Refinement {
    /// The target ship.
    pub ship: String,
    /// The source model.
    pub source: String,
    /// The estimator.
    pub method: String,
    /// The refined model.
    pub model: Model,
    /// The transferred source model, before refinement.
    pub transferred: Model,
    /// Every setting.
    pub settings: RefinementSettings,
    /// Largest condition number of the standardised regressions.
    pub condition_number: f64,
    /// Groups of coefficients that the trials cannot distinguish.
    pub collinear_groups: Vec<Vec<String>>,
    /// Errors on held-out manoeuvres.
    pub held_out: HeldOut,
    /// Every coefficient.
    pub coefficients: Vec<CoefficientChange>,
    /// Report of a search, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search: Option<SearchReport>,
    /// Every step of the widening ranges.
    pub options: Vec<StepOption>,
    /// Standard manoeuvres of the transferred source and of the refined model.
    pub manoeuvres: RefinementManoeuvres,
    /// Remarks for the person who must defend the model.
    pub remarks: Vec<String>,
}

/// Name of the step that keeps the source.
pub(super) const SOURCE_STEP: &str = "source";

impl Refinement {
    /// Returns true if the source is kept: nothing that was fitted was chosen.
    pub fn is_source_kept(&self) -> bool {
        self.options.iter().any(|option| option.chosen && option.step == SOURCE_STEP)
    }

    /// Reasons why options could not be chosen, each once.
    pub fn refusal_reasons(&self) -> String {
        join_distinct(self.options.iter().filter_map(|option| option.reason.as_deref()))
    }
}

/// Standard manoeuvres before and after.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RefinementManoeuvres {
    /// Manoeuvres of the transferred source.
    pub source: StandardManoeuvres,
    /// Manoeuvres of the refined model.
    pub refined: StandardManoeuvres,
    /// Confidence bands of the refined model's figures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bands: Option<UncertaintyBands>,
    /// Response of the refined model on a straight course.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub course: Vec<CourseFigure>,
    /// Turning circles and zigzags among the trials, measured and simulated with the recorded
    /// rudder from their start.
    pub measured: Vec<MeasuredManoeuvre>,
}

/// A manoeuvre among the trials, measured and simulated by both models.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredManoeuvre {
    /// The trial.
    pub trial: String,
    /// True if the refined model was fitted on it.
    pub fitted: bool,
    /// As measured.
    pub measured: ManoeuvreMetrics,
    /// As simulated by the transferred source; absent if that diverged.
    pub source: Option<ManoeuvreMetrics>,
    /// As simulated by the refined model.
    pub refined: Option<ManoeuvreMetrics>,
}
