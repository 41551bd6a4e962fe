//! What a diagnosis gives.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::effect::ActsOn;
use sistership_simulation::metrics::ManoeuvreMetrics;

use super::settings::Settings;

/// The answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The residual is what the noise predicts.
    Complete,
    /// Named effects are missing from the model, and with them the residual is what the noise
    /// predicts.
    Effects,
    /// Something is missing that no effect of the library explains.
    Unexplained,
}

/// The result of a diagnosis. Errors are root mean squares by channel in SI, on trials that the fit
/// has not seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// The answer.
    pub verdict: Verdict,
    /// The effects that are missing.
    pub effects: Vec<Found>,
    /// What no effect explains.
    pub unexplained: Vec<Unexplained>,
    /// Changes in time that explain what remains of a trial, the most evident first: they are of a
    /// day, and no model carries them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<Change>,
    /// Where what no effect explains comes from, the most evident first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub origins: Vec<RemainderOrigin>,
    /// On what depends what is left there, by acceleration, that of the first origin first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub depends_on: Vec<RemainderDependence>,
    /// How small each effect that was not found would still have been shown, with a probability of
    /// 90 %.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limits: Vec<DetectionLimit>,
    /// Effects of which these trials and this model cannot tell a usual size, and what stands in
    /// the way.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub cannot_tell: BTreeMap<String, LimitedBy>,
    /// Odds that were given each effect before the trials were looked at, all its forms together.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub prior_odds: BTreeMap<String, f64>,
    /// The trial that would tell the effects found from those that they are confounded with; absent
    /// where nothing is to be told apart.
    pub next_trial: Option<NextTrial>,
    /// Errors of the model as it is.
    pub before: BTreeMap<String, f64>,
    /// Errors of the model with the effects, refitted; those of `before` where there are none.
    pub after: BTreeMap<String, f64>,
    /// Standard deviation of the noise by channel, as the trials show it, SI.
    pub noise: BTreeMap<String, f64>,
    /// How trials were kept from the fit that they judge.
    pub how: String,
    /// The model that was diagnosed.
    pub diagnosed: String,
    /// Every hypothesis that was tried, the most probable first.
    pub hypotheses: Vec<Hypothesis>,
    /// Errors trial by trial.
    pub trials: Vec<TrialErrors>,
    /// Turning circles and zigzags among the trials.
    pub manoeuvres: Vec<SailedManoeuvre>,
    /// The residual over time, by trial and channel, for plots.
    pub residuals: Vec<ResidualSeries>,
    /// How much the accelerations carry that nothing explains, before and after.
    pub discrepancies: Vec<DiscrepancyLevel>,
    /// The model with the effects, where some were found.
    pub model: Option<Model>,
    /// Every setting.
    pub settings: Settings,
    /// Remarks for the person who must defend the answer.
    pub remarks: Vec<String>,
}

/// How small an effect would still have been shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DetectionLimit {
    /// The effect.
    pub effect: String,
    /// Its form.
    pub form: String,
    /// The parameter whose size is limited, the others at the absence of the effect.
    pub parameter: String,
    /// The smallest size that is shown with a probability of 90 %, SI; absent where none is.
    pub size: Option<f64>,
    /// A usual size, by the library's prior.
    pub usual: f64,
    /// What stands in the way of showing a usual size; absent where it would be shown.
    pub limited_by: Option<LimitedBy>,
}

/// What stands in the way of telling an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LimitedBy {
    /// The model leaves of its own trials what resembles the effect: refine it first.
    Model,
    /// What the trials excite does not tell it from the coefficients or from another effect.
    Trials,
    /// The instruments scatter too much.
    Sensors,
}

/// A value with its standard error, in the unit of its name.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub se: f64,
}

/// An effect that is missing from the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Its name in the library.
    pub name: String,
    /// In which form.
    pub form: String,
    /// One line for people.
    pub meaning: String,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// Its parameters and what follows from them.
    pub parameters: BTreeMap<String, Value>,
    /// Its parameters in the model that is given, where they were fitted together with the
    /// coefficients.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub in_model: BTreeMap<String, Value>,
    /// Natural logarithm of how much more probable the trials are with it than without, the other
    /// effects found being there: after what the number of hypotheses tried costs, and discounted
    /// by what the effect explains of clean trials.
    pub evidence: f64,
    /// Effects that these trials cannot tell it from, or hardly.
    pub confounded_with: Vec<Confounded>,
}

/// An effect whose answer on these trials is nearly the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Confounded {
    /// Its name.
    pub name: String,
    /// The angle between what was found and the nearest that this effect could do, deg: 0 the same,
    /// 90 nothing in common.
    pub angle_deg: f64,
    /// How much less evidence there is for it, natural logarithm.
    pub behind: f64,
}

/// A stretch of a trial that no effect explains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unexplained {
    /// The channel whose readings the model does not follow; [`RemainderOrigin`] says what is
    /// missing.
    pub channel: String,
    /// Root mean square of what remains over what the noise predicts.
    pub rms_over_noise: f64,
    /// The trial.
    pub trial: String,
    /// From when, s of the trial.
    pub from_s: f64,
    /// Until when, s of the trial.
    pub to_s: f64,
}

/// What, taken to be more random than it is known to be, makes the trials that leave something more
/// probable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RemainderOrigin {
    /// What that is.
    pub of: OriginKind,
    /// `u`, `v`, `r` or `p` of an acceleration; the channel of readings.
    pub channel: String,
    /// By how much, natural logarithm, by the standard deviation that does most.
    pub evidence: f64,
    /// Of so many trials it is the most evident origin.
    pub first_in: usize,
    /// Trials that were asked.
    pub trials: usize,
}

/// Of what kind an origin is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OriginKind {
    /// A force or moment that the equations of motion lack.
    Acceleration,
    /// An instrument.
    Readings,
}

/// An effect that changes within a trial, or that one trial alone has, and with which nothing of
/// that trial remains unexplained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// Its name in the library.
    pub effect: String,
    /// In which form.
    pub form: String,
    /// One line for people.
    pub meaning: String,
    /// The trial.
    pub trial: String,
    /// How it goes.
    pub course: ChangeCourse,
    /// When it begins or ends, s of the trial; absent where it does neither.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_s: Option<f64>,
    /// Between which times that is with a probability of 95 %, s of the trial.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_s: Option<[f64; 2]>,
    /// Its parameters and what follows from them, beside what is there otherwise; of a drift at the
    /// end of the trial.
    pub parameters: BTreeMap<String, Value>,
    /// Natural logarithm of how much more probable the trial is with it than without, after what
    /// the number of times that were tried costs.
    pub evidence: f64,
    /// Effects whose changes are nearly as evident.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub or: Vec<String>,
}

/// How a change goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ChangeCourse {
    /// It begins within the trial.
    Begins,
    /// It ends within the trial.
    Ends,
    /// It grows steadily from the beginning of the trial.
    Drifts,
    /// It is there throughout this trial, and not in all others.
    Throughout,
}

/// On what depends what is left of an acceleration in which something is unexplained, or in yaw
/// where the heading is: a random forest learned it from half of the trials' blocks of time, and
/// was asked on the others, and another one the other way round. Shares are means of both; curves
/// are the first one's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RemainderDependence {
    /// `u`, `v`, `r` or `p`.
    pub channel: String,
    /// The share of its variance that the recorded variables and time explain there; 0 where they
    /// explain nothing.
    pub explained: f64,
    /// The variables that it depends on most, the first one most.
    pub variables: Vec<VariableDependence>,
}

/// How what is left depends on a variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariableDependence {
    /// A recorded channel, or `t`, the time of the trial.
    pub variable: String,
    /// By how much of the remainder's variance the squared error rises where it is shuffled among
    /// the samples.
    pub share: f64,
    /// Its values, rising, SI.
    pub at: Vec<f64>,
    /// What is left in the mean where it is held there, m/s2 or rad/s2.
    pub remainder: Vec<f64>,
}

/// The trial that would tell effects apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextTrial {
    /// What to sail.
    pub manoeuvre: String,
    /// At which approach speed, m/s.
    pub speed_m_s: f64,
    /// On which heading, deg.
    pub heading_deg: f64,
    /// What it would tell apart.
    pub separates: Vec<String>,
    /// The evidence that it is expected to give for one over the other, natural logarithm.
    pub expected: f64,
}

/// One hypothesis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hypothesis {
    /// Its effects, as `name/form`.
    pub effects: Vec<String>,
    /// Evidence of all its effects together against the model alone, not discounted by what they
    /// explain of clean trials: a hypothesis with more of it than the one taken is not believed.
    pub evidence: f64,
    /// How much more probable trials became by it that its fit had not seen, natural logarithm;
    /// absent where it was not judged so.
    pub held_out: Option<f64>,
    /// Parameters.
    pub parameters: BTreeMap<String, Value>,
    /// Whether it was taken.
    pub taken: bool,
}

/// Errors on one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialErrors {
    /// The trial.
    pub trial: String,
    /// Of the model as it is.
    pub before: BTreeMap<String, f64>,
    /// With the effects, fitted without this trial.
    pub after: BTreeMap<String, f64>,
}

/// A manoeuvre that was sailed, measured and simulated with the recorded rudder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SailedManoeuvre {
    /// The trial.
    pub trial: String,
    /// As measured.
    pub measured: ManoeuvreMetrics,
    /// Of the model as it is; absent where its simulation diverged.
    pub before: Option<ManoeuvreMetrics>,
    /// With the effects, fitted without this trial.
    pub after: Option<ManoeuvreMetrics>,
}

/// The residual of an acceleration over a trial: what must be added to what the model gives, as the
/// filter's smoother finds it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResidualSeries {
    /// The trial.
    pub trial: String,
    /// `u`, `v`, `r` or `p`.
    pub channel: String,
    /// Time, s.
    pub t_s: Vec<f64>,
    /// Of the model as it is, m/s2 or rad/s2.
    pub before: Vec<f64>,
    /// With the effects.
    pub after: Vec<f64>,
    /// Two standard deviations of what noise alone would show.
    pub band: Vec<f64>,
    /// The recorded variable that explains most of `before`, such as `psi` or `delta`, and its
    /// values.
    pub against: String,
    /// Its values, SI.
    pub variable: Vec<f64>,
}

/// How much of an acceleration nothing explains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DiscrepancyLevel {
    /// `u`, `v`, `r` or `p`.
    pub channel: String,
    /// Standard deviation that the model brings with it from the trials it was fitted on, m/s2 or
    /// rad/s2; absent where it says nothing of it.
    pub expected: Option<f64>,
    /// On these trials, of the model as it is.
    pub before: f64,
    /// With the effects.
    pub after: f64,
}
