//! Information of the trials on which a model was fitted about its coefficients, and the
//! discrepancy that no coefficient explains.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::effect::AppliedEffect;
use crate::triangle::{self, TriangleError};

/// Information of a fit. With `d` the change of the listed coefficients, each divided by its scale,
/// minus twice the logarithm of the likelihood of the fitted trials is `|R d - z|^2`, up to a
/// constant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Uncertainty {
    /// Names of the coefficients, and of terms that the model does not have (with a value of zero).
    pub names: Vec<String>,
    /// Divisor of each change, in the unit of the coefficient.
    pub scales: Vec<f64>,
    /// The upper triangle of R, one string per row: numbers from the diagonal on, separated by
    /// spaces.
    pub root_information: Vec<String>,
    /// z.
    pub offset: Vec<f64>,
    /// Remaining accelerations by axis.
    pub discrepancy: BTreeMap<Axis, Discrepancy>,
    /// Errors of the instruments beyond the scatter of their readings, by channel.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub instruments: BTreeMap<String, InstrumentFit>,
    /// Systematic errors of instruments that these trials show, with one size for all; later trials
    /// are read with them, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub systematic_errors: Vec<AppliedEffect>,
    /// Interval between readings with independent noise, s; 0 if every sample is independent. Later
    /// trials are read in the same way.
    pub reading_interval_s: f64,
    /// Level that each form of an effect explained in these trials, which do not have the effect:
    /// by `effect/form`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub false_alarm_levels: BTreeMap<String, FalseAlarmLevel>,
    /// Largest unexplained remainder of any segment of these trials, in standard deviations, by
    /// channel.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub remainder: BTreeMap<String, f64>,
    /// Names of the trials on which it was learned.
    pub trials: Vec<String>,
}

/// An instrument, as characterised by the trials on which a model was fitted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InstrumentFit {
    /// Standard deviation of its error relative to the scatter from sample to sample: more than one
    /// if readings were smoothed.
    pub deviation_by_scatter: f64,
    /// Root of the spectral density of the difference between its rate and the velocities, SI times
    /// the root of a second.
    pub drift: f64,
}

/// Level that an effect explained in trials without it, relative to the level expected by chance:
/// one if the model is right. Each trial is judged by coefficients fitted on the others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FalseAlarmLevel {
    /// Mean over single trials.
    pub each: f64,
    /// Level of all trials together: more than `each` if one size of the effect would fit them all.
    pub together: f64,
}

/// Remainder of an acceleration: a random part of exponential autocorrelation, and a white one.
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

/// Reason for which the information of a fit cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UncertaintyError {
    /// Lists differ in length.
    #[error("names, scales and offset should have the same number")]
    Lists,
    /// A scale is not above zero.
    #[error("scales should be above 0")]
    Scales,
    /// A discrepancy is not a valid process.
    #[error("discrepancy: deviation and white should be at least 0 and time_s above 0")]
    Discrepancy,
    /// The root of the information is not an upper triangle.
    #[error(transparent)]
    Root(#[from] TriangleError),
}

impl Uncertainty {
    /// Formats R row by row; `entry(i, j)` for `j >= i`.
    pub fn format_rows(size: usize, entry: &dyn Fn(usize, usize) -> f64) -> Vec<String> {
        let row = |i: usize| {
            (i..size).map(|j| format!("{:.7e}", entry(i, j))).collect::<Vec<_>>().join(" ")
        };
        (0..size).map(row).collect()
    }

    /// R, row by row from the diagonal on.
    ///
    /// # Errors
    /// Returns an error that names the row of a wrong length, or with an entry that is not a
    /// number.
    pub fn information_root(&self) -> Result<Vec<Vec<f64>>, TriangleError> {
        let size = self.names.len();
        triangle::read_rows("root_information", &self.root_information, size, |place| size - place)
    }

    /// Checks that the lists are consistent.
    ///
    /// # Errors
    /// Returns an error that names the inconsistent lists.
    pub fn check_lists(&self) -> Result<(), UncertaintyError> {
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
        self.information_root()?;
        Ok(())
    }
}
