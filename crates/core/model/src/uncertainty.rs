//! What the trials that a model was fitted on leave open: the coefficients' information, and the
//! discrepancy that no coefficient explains.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::effect::AppliedEffect;
use crate::triangle::{self, TriangleError};

/// What a fit leaves open. With `d` the change of the listed coefficients, each divided by its
/// scale, the trials that were fitted say `|R d - z|^2` (minus twice the logarithm of their
/// likelihood, less a constant).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Uncertainty {
    /// Names of the coefficients, and of terms that the model does not have (its value for them is
    /// zero).
    pub names: Vec<String>,
    /// What each change is divided by, in the unit of the coefficient.
    pub scales: Vec<f64>,
    /// The upper triangle of R, a row in a line: numbers from the diagonal on, separated by spaces.
    pub root_information: Vec<String>,
    /// z.
    pub offset: Vec<f64>,
    /// Accelerations that remain, by axis.
    pub discrepancy: BTreeMap<Axis, Discrepancy>,
    /// What the instruments did beside the scatter that their readings show, by channel.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub instruments: BTreeMap<String, InstrumentFit>,
    /// Systematic errors of instruments: those that these trials show, one size for all; later
    /// trials are read with them, too. Versions are their bytes, so that documents keep the name
    /// under which the first were written.
    #[serde(rename = "habits", default, skip_serializing_if = "Vec::is_empty")]
    pub systematic_errors: Vec<AppliedEffect>,
    /// Whether what instruments would say later was learned from the rates that the filter expects;
    /// by those on the recorded path, whose noise is that of the readings, where absent. Later
    /// trials are read in the same way.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub expected_rates: bool,
    /// From one reading whose noise is new to the next, s; 0 where every sample is one. Later trials
    /// are read in the same way. Where absent, each set of trials is asked by the samples that are
    /// used of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reading_interval_s: Option<f64>,
    /// How much each form of an effect explained of these trials, which do not have it: by
    /// `effect/form`.
    #[serde(rename = "feigned", default, skip_serializing_if = "BTreeMap::is_empty")]
    pub false_alarm_levels: BTreeMap<String, FalseAlarmLevel>,
    /// The largest that any stretch of these trials left unexplained, in deviations, by channel.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub remainder: BTreeMap<String, f64>,
    /// Names of the trials that it was learned on.
    pub trials: Vec<String>,
}

/// An instrument as the trials that a model was fitted on show it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InstrumentFit {
    /// Deviation of its error by the scatter from sample to sample: more than one where readings
    /// were smoothed.
    pub deviation_by_scatter: f64,
    /// Root of the density of what its rate and the velocities disagree by, SI by the root of a
    /// second.
    pub drift: f64,
}

/// What an effect explained of trials that do not have it, by what chance would let it explain: one
/// where the model is right. Each trial is judged by coefficients fitted on the others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FalseAlarmLevel {
    /// Of single trials, in the mean.
    pub each: f64,
    /// Of all together: more than `each` where one size of the effect would suit them all.
    pub together: f64,
}

/// What remains of an acceleration: a random part of exponential autocorrelation, and a white one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Discrepancy {
    /// Standard deviation, m/s2 or rad/s2.
    pub deviation: f64,
    /// Correlation time, s.
    pub time_s: f64,
    /// Root of the density of the white part, m/s2 or rad/s2 times the root of a second.
    pub white: f64,
}

/// Why what a fit leaves open cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UncertaintyError {
    /// Lists differ in length.
    #[error("names, scales and offset should be equally many")]
    Lists,
    /// A scale divides by nothing.
    #[error("scales should be above 0")]
    Scales,
    /// A discrepancy is no process.
    #[error("discrepancy: deviation and white should be at least 0 and time_s above 0")]
    Discrepancy,
    /// The root information is no triangle.
    #[error(transparent)]
    Root(#[from] TriangleError),
}

impl Uncertainty {
    /// Writes R row by row; `entry(i, j)` for `j >= i`.
    pub fn rows(size: usize, entry: &dyn Fn(usize, usize) -> f64) -> Vec<String> {
        let row = |i: usize| {
            (i..size).map(|j| format!("{:.7e}", entry(i, j))).collect::<Vec<_>>().join(" ")
        };
        (0..size).map(row).collect()
    }

    /// R, row by row from the diagonal on.
    ///
    /// # Errors
    /// Names the row that is not as long as it should be, or not of numbers.
    pub fn root(&self) -> Result<Vec<Vec<f64>>, TriangleError> {
        let size = self.names.len();
        triangle::read("root_information", &self.root_information, size, |place| size - place)
    }

    /// Checks that the lists go together.
    ///
    /// # Errors
    /// Says which do not.
    pub fn check(&self) -> Result<(), UncertaintyError> {
        let size = self.names.len();
        if self.scales.len() != size || self.offset.len() != size {
            return Err(UncertaintyError::Lists);
        }
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if !self.scales.iter().all(|&scale| positive(scale)) {
            return Err(UncertaintyError::Scales);
        }
        if self.discrepancy.values().any(|d| {
            !(d.white >= 0.0
                && d.white.is_finite()
                && d.deviation >= 0.0
                && d.deviation.is_finite()
                && positive(d.time_s))
        }) {
            return Err(UncertaintyError::Discrepancy);
        }
        self.root()?;
        Ok(())
    }
}
