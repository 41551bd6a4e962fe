//! Result of a diagnosis.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::effect::ActsOn;
use sistership_simulation::metrics::ManoeuvreMetrics;

use super::effect_history::EffectHistory;
use super::settings::Settings;

/// Verdict of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The residual agrees with the noise.
    Complete,
    /// Named effects are missing from the model, and with them the residual agrees with the noise.
    Effects,
    /// Something is missing that no effect of the library explains.
    Unexplained,
}

/// Result of a diagnosis. Errors are root mean squares by channel in SI, on trials that the fit has
/// not seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Verdict.
    pub verdict: Verdict,
    /// Effects that are missing.
    pub effects: Vec<MissingEffect>,
    /// Segments that no effect explains.
    pub unexplained: Vec<UnexplainedSegment>,
    /// Patterns of the remainder where no segment stands out by itself, the most evident first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub patterns: Vec<RemainderPattern>,
    /// Information of these and earlier trials on the effects of the ship, for its next diagnosis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub history: Option<EffectHistory>,
    /// Changes in time that explain the remainder of a trial, the most evident first: they belong
    /// to one day, and no model carries them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<EffectChange>,
    /// Origins of the unexplained remainder, the most evident first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub origins: Vec<RemainderOrigin>,
    /// Dependence of the remainder on variables, by acceleration, that of the first origin first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub depends_on: Vec<RemainderDependence>,
    /// Detection limit of each effect that was not found, with a probability of 90 %.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limits: Vec<DetectionLimit>,
    /// Effects of which these trials and this model cannot show a usual size, with the cause.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub cannot_tell: BTreeMap<String, LimitedBy>,
    /// Prior odds of each effect, all its forms together.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub prior_odds: BTreeMap<String, f64>,
    /// Trial that would distinguish the effects found from those that they are confounded with;
    /// absent where nothing has to be distinguished.
    pub next_trial: Option<NextTrial>,
    /// Errors of the given model.
    pub before: BTreeMap<String, f64>,
    /// Errors of the model with the effects, refitted; those of `before` where there are none.
    pub after: BTreeMap<String, f64>,
    /// Standard deviation of the noise by channel, as the trials show it, SI.
    pub noise: BTreeMap<String, f64>,
    /// Description of the trials that were held out of the fit that they judge.
    pub how: String,
    /// Name of the diagnosed model.
    pub diagnosed: String,
    /// All hypotheses that were judged, the most probable first.
    pub hypotheses: Vec<HypothesisReport>,
    /// Errors by trial.
    pub trials: Vec<TrialErrors>,
    /// Turning circles and zigzags among the trials.
    pub manoeuvres: Vec<ManoeuvreOutcome>,
    /// The residual over time, by trial and channel, for plots.
    pub residuals: Vec<ResidualSeries>,
    /// Level of the unexplained accelerations, before and after.
    pub discrepancies: Vec<DiscrepancyLevel>,
    /// Model with the effects, where some were found.
    pub model: Option<Model>,
    /// All settings.
    pub settings: Settings,
    /// Remarks for the person who has to justify the result.
    pub remarks: Vec<String>,
}

/// Detection limit of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DetectionLimit {
    /// Effect.
    pub effect: String,
    /// Form of the effect.
    pub form: String,
    /// Parameter whose size is limited, the others at the absence of the effect.
    pub parameter: String,
    /// Smallest size that is shown with a probability of 90 %, SI; absent where none is.
    pub size: Option<f64>,
    /// Usual size, by the library's prior.
    pub usual: f64,
    /// Cause that prevents a usual size from being shown; absent where it would be shown.
    pub limited_by: Option<LimitedBy>,
}

/// Cause that prevents an effect from being shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LimitedBy {
    /// The model leaves a remainder on its own trials that resembles the effect: refine it first.
    Model,
    /// The trials do not distinguish the effect from the coefficients or from another effect.
    Trials,
    /// The instruments have too much noise.
    Sensors,
}

/// Value with its standard error, in the unit of its name.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ValueWithError {
    /// Value.
    pub value: f64,
    /// Standard error.
    pub se: f64,
}

/// An effect that is missing from the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissingEffect {
    /// Name in the library.
    pub name: String,
    /// Form of the effect.
    pub form: String,
    /// Description in one line.
    pub meaning: String,
    /// Target of its action.
    pub acts_on: ActsOn,
    /// Parameters, and quantities that follow from them.
    pub parameters: BTreeMap<String, ValueWithError>,
    /// Parameters in the resulting model, where they were fitted together with the coefficients.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub in_model: BTreeMap<String, ValueWithError>,
    /// Natural logarithm of the ratio of the trials' probability with it to that without, given the
    /// other effects found: it includes the cost of the number of hypotheses, and is discounted by
    /// the effect's improvement on clean trials.
    pub evidence: f64,
    /// Effects that these trials can hardly distinguish from it, or not at all.
    pub confounded_with: Vec<ConfoundedEffect>,
}

/// Effect with nearly the same response on these trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConfoundedEffect {
    /// Name in the library.
    pub name: String,
    /// Angle between the effect found and the nearest response of this effect, deg: 0 the same, 90
    /// nothing in common.
    pub angle_deg: f64,
    /// Evidence against it relative to the effect found, natural logarithm.
    pub behind: f64,
}

/// Segment of a trial that no effect explains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnexplainedSegment {
    /// Channel whose readings the model does not follow; [`RemainderOrigin`] has the cause.
    pub channel: String,
    /// Root mean square of the remainder by that of the predicted noise.
    pub rms_over_noise: f64,
    /// Name of the trial.
    pub trial: String,
    /// Beginning, s of the trial.
    pub from_s: f64,
    /// End, s of the trial.
    pub to_s: f64,
}

/// Acceleration or instrument whose larger randomness makes the trials with a remainder more
/// probable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RemainderOrigin {
    /// Kind of the origin.
    pub of: OriginKind,
    /// `u`, `v`, `r` or `p` of an acceleration; the channel of readings.
    pub channel: String,
    /// Evidence with the best standard deviation, natural logarithm.
    pub evidence: f64,
    /// Number of trials of which it is the most evident origin.
    pub first_in: usize,
    /// Number of trials that were examined.
    pub trials: usize,
}

/// Dependence of the remainder of an acceleration over all trials, where no segment stands out by
/// itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RemainderPattern {
    /// `u`, `v`, `r` or `p`.
    pub channel: String,
    /// Channel on which it depends: `psi`, `u`, `delta`, `n`; `t` for the time of a trial, `period`
    /// where it oscillates.
    pub variable: String,
    /// The period, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period_s: Option<f64>,
    /// Natural logarithm of the ratio of the trials' probability with it to that without, less that
    /// of the number of patterns that were tested, discounted by its level on clean trials.
    pub evidence: f64,
}

/// Kind of an origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OriginKind {
    /// A force or moment that the equations of motion lack.
    Acceleration,
    /// An instrument.
    Readings,
}

/// Effect that changes within a trial, or that one trial alone has, and with which nothing of that
/// trial remains unexplained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EffectChange {
    /// Name in the library.
    pub effect: String,
    /// Form of the effect.
    pub form: String,
    /// Description in one line.
    pub meaning: String,
    /// Name of the trial.
    pub trial: String,
    /// Course of the change.
    pub course: ChangeCourse,
    /// Time at which it begins or ends, s of the trial; absent where it does neither.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_s: Option<f64>,
    /// Interval of that time with a probability of 95 %, s of the trial.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_s: Option<[f64; 2]>,
    /// Parameters, and quantities that follow from them, in addition to those present otherwise;
    /// for a drift, at the end of the trial.
    pub parameters: BTreeMap<String, ValueWithError>,
    /// Natural logarithm of the ratio of the trial's probability with it to that without; it
    /// includes the cost of the number of times that were evaluated.
    pub evidence: f64,
    /// Effects whose changes are nearly as evident.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub or: Vec<String>,
}

/// Course of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ChangeCourse {
    /// It begins within the trial.
    Begins,
    /// It ends within the trial.
    Ends,
    /// It grows steadily from the beginning of the trial.
    Drifts,
    /// It is present throughout this trial, and not in all others.
    Throughout,
}

/// Dependence of the remainder of an acceleration that has an unexplained segment, or of yaw for a
/// heading that has one: a random forest was trained on half of the trials' blocks of time and
/// evaluated on the others, and another one the other way round. Shares are means of both; curves
/// are those of the first one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RemainderDependence {
    /// `u`, `v`, `r` or `p`.
    pub channel: String,
    /// Share of its variance that the recorded variables and time explain there; 0 where they
    /// explain nothing.
    pub explained: f64,
    /// Variables on which it depends most, the most important one first.
    pub variables: Vec<VariableDependence>,
}

/// Dependence of the remainder on a variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariableDependence {
    /// A recorded channel, or `t`, the time of the trial.
    pub variable: String,
    /// Increase of the squared error, by the remainder's variance, where the variable is shuffled
    /// among the samples.
    pub share: f64,
    /// Values of the variable, increasing, SI.
    pub at: Vec<f64>,
    /// Mean remainder where the variable has that value, m/s2 or rad/s2.
    pub remainder: Vec<f64>,
}

/// Trial that would distinguish effects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextTrial {
    /// Manoeuvre.
    pub manoeuvre: String,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Heading, deg.
    pub heading_deg: f64,
    /// Effects that it would distinguish.
    pub separates: Vec<String>,
    /// Expected evidence for one over the other, natural logarithm.
    pub expected: f64,
}

/// A judged hypothesis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HypothesisReport {
    /// Effects, as `name/form`.
    pub effects: Vec<String>,
    /// Evidence of all its effects together against the model alone, not discounted by their
    /// improvement on clean trials: a hypothesis with more of it than the accepted one was refused
    /// for another reason.
    pub evidence: f64,
    /// Gain in the logarithm of the probability of held-out trials; absent where it was not judged
    /// so.
    pub held_out: Option<f64>,
    /// Parameters.
    pub parameters: BTreeMap<String, ValueWithError>,
    /// True if its effects are those of the result.
    pub taken: bool,
    /// Reason for which it is not the result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
}

/// Errors on one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialErrors {
    /// Name of the trial.
    pub trial: String,
    /// Errors of the given model.
    pub before: BTreeMap<String, f64>,
    /// Errors with the effects, fitted without this trial.
    pub after: BTreeMap<String, f64>,
}

/// A recorded manoeuvre, measured and simulated with the recorded rudder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ManoeuvreOutcome {
    /// Name of the trial.
    pub trial: String,
    /// Measured values.
    pub measured: ManoeuvreMetrics,
    /// Values of the given model; absent where its simulation diverged.
    pub before: Option<ManoeuvreMetrics>,
    /// Values with the effects, fitted without this trial.
    pub after: Option<ManoeuvreMetrics>,
}

/// Residual of an acceleration over a trial: the addition to the model's acceleration by the
/// filter's smoother.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResidualSeries {
    /// Name of the trial.
    pub trial: String,
    /// `u`, `v`, `r` or `p`.
    pub channel: String,
    /// Time, s.
    pub t_s: Vec<f64>,
    /// Residual of the given model, m/s2 or rad/s2.
    pub before: Vec<f64>,
    /// Residual with the effects, m/s2 or rad/s2.
    pub after: Vec<f64>,
    /// Two standard deviations of the smoother for noise alone.
    pub band: Vec<f64>,
    /// Recorded variable that explains most of `before`, such as `psi` or `delta`.
    pub against: String,
    /// Values of that variable, SI.
    pub variable: Vec<f64>,
}

/// Level of the unexplained part of an acceleration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DiscrepancyLevel {
    /// `u`, `v`, `r` or `p`.
    pub channel: String,
    /// Standard deviation by the model's calibration, m/s2 or rad/s2; absent for a model without
    /// one.
    pub expected: Option<f64>,
    /// Level on these trials of the given model.
    pub before: f64,
    /// Level with the effects.
    pub after: f64,
}
