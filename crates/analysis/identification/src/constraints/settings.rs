//! Constraints that can be requested of a refined model.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Limits that a refinement keeps to; none by default.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Constraints {
    /// Physical signs, for those of the coefficients that the model has: drift and yaw are damped
    /// (`Y_v`, `N_r` at most 0), the rudder turns the ship to its side and pushes the stern the
    /// other way (`N_delta` at least 0, `Y_delta` at most 0).
    pub physical_signs: bool,
    /// Surge terms dissipate energy: ahead, surge acceleration falls with speed over the speeds
    /// that the trials covered, and the rudder causes resistance (`X_deltadelta` at most 0).
    pub dissipative: bool,
    /// Largest distance of a coefficient from the source, in standard deviations of its prior
    /// (`moved_sd`).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub trust_sd: Option<f64>,
    /// Bounds by coefficient, in the law's units.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub bounds: BTreeMap<String, Bound>,
    /// Straight-line stability with the rudder amidships at the approach speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub straight_line: Option<StraightLine>,
}

/// Bounds of a coefficient.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Bound {
    /// Least value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Greatest value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

/// Behaviour of a ship after a small disturbance with the rudder amidships.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StraightLine {
    /// The ship settles on a new straight course.
    Stable,
    /// The ship starts to turn.
    Unstable,
}

/// The error type for constraints that are refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ConstraintError {
    /// The size of the trust region is not above 0.
    #[error("trust_sd must be above 0")]
    TrustRegion,
    /// The bounds of a coefficient are missing or not finite.
    #[error("bounds.{0}: give `min`, `max` or both, as finite numbers")]
    NoBound(String),
    /// The bounds of a coefficient exclude everything.
    #[error("bounds.{0}: min is above max")]
    Inverted(String),
}

impl Constraints {
    /// Returns true if no constraint is requested.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// Returns an error with the setting that is out of range.
    pub fn check(&self) -> Result<(), ConstraintError> {
        if self.trust_sd.is_some_and(|sd| !(sd > 0.0 && sd.is_finite())) {
            return Err(ConstraintError::TrustRegion);
        }
        for (name, Bound { min, max }) in &self.bounds {
            let finite = |value: &Option<f64>| value.is_none_or(f64::is_finite);
            if !finite(min) || !finite(max) || (min.is_none() && max.is_none()) {
                return Err(ConstraintError::NoBound(name.clone()));
            }
            if min.zip(*max).is_some_and(|(min, max)| min > max) {
                return Err(ConstraintError::Inverted(name.clone()));
            }
        }
        Ok(())
    }
}
