//! What a refinement gives, and why it may be refused.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::trial::Channel;
use sistership_simulation::PlantError;
use sistership_simulation::manoeuvre::{Figure, StandardManoeuvres};
use sistership_simulation::metrics::ManoeuvreMetrics;

use super::cma_es::SearchReport;
use super::settings::Settings;
use crate::constraints::LimitError;
use sistership_assessment::uncertainty::{Band, Bands};
use sistership_priors::transfer::UnknownParameter;

/// Why a refinement is refused.
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
    /// The law cannot be used so.
    #[error("{0}")]
    Law(String),
    /// There is too little to fit on.
    #[error("{0}")]
    Data(String),
    /// A setting is out of range.
    #[error("settings.{field}: {message}")]
    Setting {
        /// The setting.
        field: String,
        /// What it may be.
        message: String,
    },
    /// Every option left the physical range or cannot keep the constraints.
    #[error("no option can be taken: {0}")]
    Diverged(String),
    /// The constraints cannot be kept.
    #[error(transparent)]
    Constraints(#[from] LimitError),
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl RefineError {
    /// Nothing can be taken, for these reasons.
    pub fn diverged<'a>(reasons: impl Iterator<Item = &'a str>) -> Self {
        Self::Diverged(each_once(reasons))
    }
}

/// Reasons in their order; many options share one.
fn each_once<'a>(reasons: impl Iterator<Item = &'a str>) -> String {
    let mut told: Vec<&str> = Vec::new();
    for reason in reasons {
        if !told.contains(&reason) {
            told.push(reason);
        }
    }
    told.join("; ")
}

impl From<UnknownParameter> for RefineError {
    fn from(error: UnknownParameter) -> Self {
        Self::Law(error.to_string())
    }
}

/// How one coefficient moved.
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

/// One step of the widening ranges, with what it would give.
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
    /// Standardised mean squared error of simulated manoeuvres left out, the geometric mean over
    /// restart intervals; none where a simulation diverged at the shortest.
    pub error: Option<f64>,
    /// Whether this option was taken.
    pub chosen: bool,
    /// Why it could not be taken, if so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl Manoeuvres {
    /// What to know first where the trials leave much open: the widest band of an advance or
    /// tactical diameter that is wider than half the figure, or of a first overshoot that is wider
    /// than the 10 deg between the least and the most that MSC.137(76) allows.
    pub fn wide_band(&self) -> Option<String> {
        let bands = self.bands.as_ref()?;
        let width = |figure: &Figure| {
            let allowed = allowed_width(figure)?;
            let band = bands.of(&figure.name)?;
            let width = (band.high - band.low) / allowed;
            (width > 1.0).then_some((width, band.clone()))
        };
        let figures = self.refined.figures();
        let wide = figures.iter().filter_map(width);
        let (_, band) = wide.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let Band { figure, unit, low, high, .. } = band;
        Some(format!(
            "These trials leave much open: {figure} is between {low:.0} and {high:.0} {unit} (95 %)"
        ))
    }
}

/// How wide a figure's band may be before it is said first; none of figures that are not judged so.
fn allowed_width(figure: &Figure) -> Option<f64> {
    let is = |name: &str| figure.name.ends_with(name);
    if is("first overshoot") {
        return Some(10.0);
    }
    let turns = is("advance") || is("tactical diameter");
    figure.value.filter(|_| turns).map(|value| 0.5 * value.abs())
}

/// Root mean square errors by channel (SI), on manoeuvres left out.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldOut {
    /// The source model carried over to the ship.
    pub source: BTreeMap<String, f64>,
    /// The refined model.
    pub refined: BTreeMap<String, f64>,
    /// How the manoeuvres were left out.
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
    /// The source model carried over to the ship, before refinement.
    pub transferred: Model,
    /// Every setting.
    pub settings: Settings,
    /// Largest condition number of the standardised regressions.
    pub condition_number: f64,
    /// Coefficients that the trials cannot tell apart.
    pub collinear_groups: Vec<Vec<String>>,
    /// Errors on manoeuvres left out.
    pub held_out: HeldOut,
    /// Every coefficient.
    pub coefficients: Vec<CoefficientChange>,
    /// What a search did, where one was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search: Option<SearchReport>,
    /// Every step of the widening ranges.
    pub options: Vec<StepOption>,
    /// Standard manoeuvres of the source carried over and of the refined model.
    pub manoeuvres: Manoeuvres,
    /// Remarks for the person who must defend the model.
    pub remarks: Vec<String>,
}

/// What the step of the source as it is is called.
pub(super) const SOURCE_STEP: &str = "source";

impl Refinement {
    /// Whether the source stays as it is: nothing that was fitted is taken.
    pub fn is_source_kept(&self) -> bool {
        self.options.iter().any(|option| option.chosen && option.step == SOURCE_STEP)
    }

    /// Why options could not be taken.
    pub fn refusals(&self) -> String {
        each_once(self.options.iter().filter_map(|option| option.reason.as_deref()))
    }
}

/// Standard manoeuvres before and after.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Manoeuvres {
    /// Of the source carried over.
    pub source: StandardManoeuvres,
    /// Of the refined model.
    pub refined: StandardManoeuvres,
    /// Confidence bands of the refined model's figures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bands: Option<Bands>,
    /// Turning circles and zigzags among the trials, measured and simulated with the recorded
    /// rudder from their start.
    pub measured: Vec<MeasuredManoeuvre>,
}

/// A manoeuvre that was sailed at sea, and what the models make of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredManoeuvre {
    /// The trial.
    pub trial: String,
    /// Whether the refined model was fitted on it.
    pub fitted: bool,
    /// As measured.
    pub measured: ManoeuvreMetrics,
    /// As simulated by the source carried over; absent where that diverged.
    pub source: Option<ManoeuvreMetrics>,
    /// As simulated by the refined model.
    pub refined: Option<ManoeuvreMetrics>,
}
