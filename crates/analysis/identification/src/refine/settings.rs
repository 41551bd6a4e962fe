//! Settings of a refinement.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cma_es::CmaEs;
use super::family::TermFamily;
use super::thresholds::ESTIMATE_POSITION;
use crate::constraints::Constraints;
use sistership_assessment::uncertainty::Sampling;

/// Revision of the algorithm of this program. It rises with each change after which the same
/// settings give another model.
pub const ALGORITHM_REVISION: u32 = 4;

/// The estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Estimator")]
pub enum EstimationMethod {
    /// One-step differences and the ridge with the source as l2 prior: Kanazawa 2023, Eqs.
    /// 5.4-5.17.
    #[default]
    Published,
    /// The equations of motion integrated over windows with smooth bump functions, without
    /// differentiation of measurements; the same ridge.
    Weak,
    /// Simulated segments against the trials by forward sensitivities, started from the weak form,
    /// which is also the prior.
    Trajectory,
    /// Simulated subsequences against the trials by CMA-ES, a random search with an adapted
    /// covariance: Miyauchi 2024, Eqs. 19-33.
    #[serde(rename = "cma-es")]
    CmaEs,
}

impl EstimationMethod {
    /// Every estimator.
    pub const ALL: [Self; 4] = [Self::Published, Self::Weak, Self::Trajectory, Self::CmaEs];

    /// The estimator of that name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Published => "published",
            Self::Weak => "weak",
            Self::Trajectory => "trajectory",
            Self::CmaEs => "cma-es",
        }
    }

    /// Returns true if the estimator keeps constraints: linear regressions do, since the nearest
    /// point within the limits is a convex problem.
    pub(super) fn keeps_constraints(self) -> bool {
        matches!(self, Self::Published | Self::Weak)
    }
}

/// Mean of the prior.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Prior {
    /// The source model, transferred to the ship.
    #[default]
    Source,
    /// The source and the estimate from particulars, weighted by their errors on ships that were
    /// left out (docs/evidence/strangers.md).
    Mixture,
    /// The mean of other ships, with their differences as covariance (docs/evidence/population.md).
    /// The source, which must be of another law than the one fitted, determines the states at which
    /// they are evaluated.
    Population,
}

/// Origin of a refinement without a source.
pub const TRIALS_ALONE: &str = "the trials alone";

impl Prior {
    /// Every prior.
    pub const ALL: [Self; 3] = [Self::Source, Self::Mixture, Self::Population];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Source => "source",
            Self::Mixture => "mixture",
            Self::Population => "population",
        }
    }

    /// The prior of that name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|prior| prior.name() == name)
    }

    fn is_source(&self) -> bool {
        *self == Self::Source
    }
}

/// A range in which (lambda, alpha) are tuned.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "TuningRange")]
pub struct TuningRange {
    /// Least strength of the prior.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lambda_min: f64,
    /// Greatest strength of the prior.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lambda_max: f64,
    /// Largest share of the zero vector in the prior.
    #[schemars(range(min = 0, max = 1))]
    pub alpha_max: f64,
}

/// Settings of a refinement; all of them are stored with the version.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "RefinementSettings")]
pub struct RefinementSettings {
    /// Revision of the algorithm. Versions keep it, so that another revision is never taken for the
    /// one that made them.
    #[schemars(range(min = ALGORITHM_REVISION, max = ALGORITHM_REVISION))]
    pub algorithm_revision: u32,
    /// The estimator.
    pub method: EstimationMethod,
    /// Mean of the prior.
    #[serde(skip_serializing_if = "Prior::is_source")]
    pub prior: Prior,
    /// SHA-256 of the regressions by which a `mixture` estimates the ship. Default: those of the
    /// program. Not used if the prior is the source.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regressions_sha256: Option<String>,
    /// Positions of the mean of a `mixture`: 0 at the source, 0.5 at the learned shares, 1 at the
    /// estimate. Of several positions the trials choose one. Default: five positions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 20), extend("items" = { "type": "number", "format": "double", "minimum": 0, "maximum": 1 }))]
    pub mixture_positions: Vec<f64>,
    /// Tuning ranges from the source outwards; each gives an option, the best of which is chosen.
    #[schemars(length(min = 1, max = 20))]
    pub ranges: Vec<TuningRange>,
    /// Values of lambda tried in a range, evenly spaced in their logarithm.
    #[schemars(range(min = 2, max = 1000))]
    pub lambda_count: usize,
    /// Time over which accelerations are differenced, s, at least one sampling interval. Default: a
    /// tenth of the time in which the ship travels its own length, since at shorter times the noise
    /// of the instruments exceeds the acceleration.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub difference_s: Option<f64>,
    /// Length of the weak form's windows, s. Default: the time in which the ship travels its own
    /// length.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub window_s: Option<f64>,
    /// Distance from one window of the weak form to the next, s. Default: a tenth of a window.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub hop_s: Option<f64>,
    /// Length of the trajectory form's segments, s. Default: five times the time in which the ship
    /// travels its own length; for `cma-es` ten times, and at least 100 s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub segment_s: Option<f64>,
    /// Time from one residual of the trajectory form to the next, s. Default: a 7.5th of the time
    /// in which the ship travels its own length; for `cma-es` one sampling interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub residual_s: Option<f64>,
    /// Integration step of the trajectory form, s, rounded to sampling intervals. Default: a
    /// thirtieth of the time in which the ship travels its own length; for `cma-es` a 75th, as a
    /// multiple or a whole fraction of a sampling interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub step_s: Option<f64>,
    /// Settings of `cma-es`; absent for other methods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cma_es: Option<CmaEs>,
    /// Families of terms among which the weak and the trajectory form choose. Default: all of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub families: Vec<TermFamily>,
    /// Strengths of the prior among which the weak and the trajectory form choose, from the source
    /// outwards. Default: half decades from 10 to 1e-8.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100), extend("items" = { "type": "number", "format": "double", "exclusiveMinimum": 0 }))]
    pub strengths: Vec<f64>,
    /// Restart interval of simulations of held-out manoeuvres, s. Default: ten times the time in
    /// which the ship travels its own length, or five times in the default search. An interval
    /// longer than a trial simulates the trial as a whole.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub restart_s: Option<f64>,
    /// Longer restart intervals, s, at which held-out manoeuvres are simulated as well: the error
    /// by which candidates are compared is the geometric mean over all intervals. A simulation that
    /// stops early counts there with the error of an unrelated motion. Default: `restart_s` alone.
    /// The default search sets it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 10), extend("items" = { "type": "number", "format": "double", "exclusiveMinimum": 0 }))]
    pub longer_restarts_s: Vec<f64>,
    /// Window, s, over which the motions are smoothed in which such simulations start and with
    /// which they are compared: the effect of one noisy reading at the start of a simulation grows
    /// if a ship is unstable on a straight course. Default: motions as recorded. The default search
    /// sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub smoothing_s: Option<f64>,
    /// Largest number of folds; with more manoeuvres than that, several are held out together.
    #[schemars(range(min = 2, max = 100))]
    pub folds: usize,
    /// Length of a part where trials are held out part by part, s; each trial has at least two
    /// parts. Default: the restart interval. The default search sets it to ten times the time in
    /// which the ship travels its own length if there are three trials or more.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub part_s: Option<f64>,
    /// Hold trials out part by part, and choose only a fit that is clearly better than the source:
    /// for one or two trials, where holding a whole one out leaves too little. The default search
    /// sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub hold_out_parts: bool,
    /// Strength of the prior of roll relative to the likeliest by the trials, dimensionless. The
    /// default search sets it where a model capsizes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_strength: Option<f64>,
    /// Number of samples, about, of the whole trials on which the noise model is learned: those
    /// trials that differ most. Default: all samples. The default search sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub calibration_samples: Option<usize>,
    /// Names of trials that are held out of fit and choice altogether, to judge the result.
    pub held_out: Vec<String>,
    /// Constraints on the refined model.
    #[serde(skip_serializing_if = "Constraints::is_empty")]
    pub constraints: Constraints,
    /// Sampling of the posterior for the uncertainty bands of the standard manoeuvres; no samples,
    /// no bands.
    pub bands: Sampling,
}

impl Default for RefinementSettings {
    fn default() -> Self {
        // Each range reaches a decade further from the source, and allows a tenth more of alpha.
        let range = |exponent: i32| TuningRange {
            lambda_min: 10_f64.powi(-exponent),
            lambda_max: 1e10,
            alpha_max: (0.1 * f64::from(1 + exponent)).min(1.0),
        };
        Self {
            algorithm_revision: ALGORITHM_REVISION,
            method: EstimationMethod::Published,
            prior: Prior::Source,
            regressions_sha256: None,
            mixture_positions: Vec::new(),
            ranges: (0..=6).map(range).collect(),
            lambda_count: 100,
            difference_s: None,
            window_s: None,
            hop_s: None,
            segment_s: None,
            residual_s: None,
            step_s: None,
            cma_es: None,
            families: Vec::new(),
            strengths: Vec::new(),
            restart_s: None,
            longer_restarts_s: Vec::new(),
            smoothing_s: None,
            folds: 8,
            part_s: None,
            hold_out_parts: false,
            roll_strength: None,
            calibration_samples: None,
            held_out: Vec::new(),
            constraints: Constraints::default(),
            bands: Sampling::default(),
        }
    }
}

impl RefinementSettings {
    /// Fills in the families and strengths among which model selection chooses, so that a version
    /// records them.
    pub(super) fn fill_selection(&mut self, families: &[TermFamily]) {
        if self.families.is_empty() {
            self.families = families.to_vec();
        }
        if self.strengths.is_empty() {
            self.strengths = (0..=18).map(|k| 10_f64.powf(1.0 - 0.5 * f64::from(k))).collect();
        }
    }

    /// Returns the origin of a refinement with these settings, for reports: the source's name, or
    /// the prior that replaces it; [`TRIALS_ALONE`] if there is no source.
    pub fn prior_origin<'a>(&self, source: Option<&'a str>) -> &'a str {
        match self.prior {
            Prior::Mixture if self.mixture_positions == [ESTIMATE_POSITION] => {
                "the estimate from particulars"
            }
            Prior::Population => "a population of ships",
            Prior::Mixture | Prior::Source => source.unwrap_or(TRIALS_ALONE),
        }
    }

    /// Returns the smoothing window, s, of the motions with which simulations of held-out
    /// manoeuvres are compared; errors on trials that are kept out altogether refer to motions as
    /// recorded.
    pub fn compared_smoothing_s(&self) -> Option<f64> {
        self.smoothing_s.filter(|_| self.held_out.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_in_the_place_of_a_source_is_named() {
        let of = |prior, positions: &[f64], source: Option<&str>| {
            let mixture_positions = positions.to_vec();
            let settings =
                RefinementSettings { prior, mixture_positions, ..RefinementSettings::default() };
            settings.prior_origin(source).to_owned()
        };
        assert_eq!(of(Prior::Source, &[], Some("wpcc/1")), "wpcc/1");
        assert_eq!(of(Prior::Source, &[], None), TRIALS_ALONE);
        assert_eq!(of(Prior::Population, &[], Some("wpcc/1")), "a population of ships");
        assert_eq!(of(Prior::Mixture, &[0.5], Some("wpcc/1")), "wpcc/1");
        assert_eq!(of(Prior::Mixture, &[1.0], Some("wpcc/1")), "the estimate from particulars");
    }
}
