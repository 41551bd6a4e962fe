//! What a refinement may be told.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cma_es::CmaEs;
use super::family::Family;
use super::thresholds::ESTIMATE_POSITION;
use crate::constraints::Constraints;
use sistership_assessment::uncertainty::Sampling;

/// The estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Estimator")]
pub enum Method {
    /// One-step differences and the ridge with the source as l2 prior: Kanazawa 2023, Eqs.
    /// 5.4-5.17.
    #[default]
    Published,
    /// The equations of motion integrated over windows with smooth bumps, nothing differentiated;
    /// the same ridge.
    Weak,
    /// Simulated segments against the trials by forward sensitivities, started from the weak form
    /// and held by it.
    Trajectory,
    /// Simulated subsequences against the trials by a random search with a covariance that adapts:
    /// Miyauchi 2024, Eqs. 19-33.
    #[serde(rename = "cma-es")]
    CmaEs,
}

impl Method {
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

    /// Whether it keeps constraints: of linear regressions the nearest point within them is at
    /// hand.
    pub(super) fn keeps_constraints(self) -> bool {
        matches!(self, Self::Published | Self::Weak)
    }
}

/// What the prior is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Prior {
    /// The source, carried over to the ship.
    #[default]
    Source,
    /// The source and the estimate from particulars, weighted by how far each was from ships that
    /// were left out (docs/evidence/strangers.md).
    Mixture,
    /// What other ships say: their mean, held in each direction by how they differ
    /// (docs/evidence/population.md). The source, which is of another law than what is fitted, says
    /// at which states they are asked.
    Population,
}

/// Positions of a mixture among which trials choose where an order says nothing else: source,
/// learned shares and estimate, and halfway between.
const MIXTURE_POSITIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// What a refinement without a source is from.
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
pub struct Range {
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

/// Settings of a refinement; every one is kept with the version.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "RefinementSettings")]
pub struct Settings {
    /// The estimator.
    pub method: Method,
    /// What the prior is about.
    #[serde(skip_serializing_if = "Prior::is_source")]
    pub prior: Prior,
    /// SHA-256 of the regressions by which a `mixture` estimates the ship. Where absent, those of
    /// the program; nothing where the prior is the source.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regressions_sha256: Option<String>,
    /// Where the mean of a `mixture` may stand: 0 at the source, 0.5 where the learned shares put it,
    /// 1 at the estimate. Of several the trials choose. Where an order leaves it empty, five of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 20), extend("items" = { "type": "number", "format": "double", "minimum": 0, "maximum": 1 }))]
    pub mixture_positions: Vec<f64>,
    /// Tuning ranges from the source outwards; each gives an option, the best of which is chosen.
    #[schemars(length(min = 1, max = 20))]
    pub ranges: Vec<Range>,
    /// Values of lambda tried in a range, evenly spaced in their logarithm.
    #[schemars(range(min = 2, max = 1000))]
    pub lambda_count: usize,
    /// Time over which accelerations are differenced, s, at least one sampling interval. Where
    /// absent, a tenth of the time in which the ship sails its length: what the instruments add at
    /// a shorter one drowns the acceleration.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub difference_s: Option<f64>,
    /// Length of the weak form's windows, s. Where absent, the time in which the ship sails its
    /// length.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub window_s: Option<f64>,
    /// From one window of the weak form to the next, s. Where absent, a tenth of a window.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub hop_s: Option<f64>,
    /// Length of the trajectory form's segments, s. Where absent, five times the time in which the
    /// ship sails its length; for the search ten times, and at least 100 s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub segment_s: Option<f64>,
    /// From one residual of the trajectory form to the next, s. Where absent, a 7.5th of the time
    /// in which it sails its length; for the search one sampling interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub residual_s: Option<f64>,
    /// Integration step of the trajectory form, s, rounded to sampling intervals. Where absent, a
    /// thirtieth of the time in which it sails its length; for the search a 75th, whole or in
    /// whole parts of an interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub step_s: Option<f64>,
    /// Of the search; absent for other methods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cma_es: Option<CmaEs>,
    /// Families of terms among which the weak and the trajectory form choose. Where empty, all of
    /// them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub families: Vec<Family>,
    /// Strengths of the prior among which they choose, from the source outwards. Where empty, half
    /// decades from 10 to 1e-8.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100), extend("items" = { "type": "number", "format": "double", "exclusiveMinimum": 0 }))]
    pub strengths: Vec<f64>,
    /// Simulations of manoeuvres left out start anew every so often, s. Where absent, ten times the
    /// time in which the ship sails its length, or five times where the default search compares;
    /// longer than a trial runs it whole.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub restart_s: Option<f64>,
    /// Longer restart intervals, s, at which manoeuvres left out are simulated, too: the error by
    /// which candidates are compared is the geometric mean over all intervals. A simulation that
    /// stops early counts there with what an unrelated motion would have. Where empty, `restart_s`
    /// alone. The default search sets it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 10), extend("items" = { "type": "number", "format": "double", "exclusiveMinimum": 0 }))]
    pub longer_restarts_s: Vec<f64>,
    /// Such simulations start in, and are compared with, motions that are smoothed over so many
    /// seconds: what one noisy reading does at the start of a simulation grows where a ship is
    /// unstable on her course. Where absent, motions as recorded. The default search sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub smoothing_s: Option<f64>,
    /// Most folds; with more manoeuvres than that, several are left out together.
    #[schemars(range(min = 2, max = 100))]
    pub folds: usize,
    /// Where trials are left out part by part, how long each part is, s, at least two of each trial.
    /// Where absent, as long as simulations run between restarts. The default search sets it to ten
    /// times the time in which the ship sails its length from three trials on.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub part_s: Option<f64>,
    /// Trials are left out part by part, each as long as simulations run between restarts, and what
    /// is taken must be clearly better than the source: for one or two trials, where leaving one
    /// out leaves too little. The default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub in_parts: bool,
    /// The steering gear's rate is read from the rudder's movements in the trials, where these show
    /// it; else it is the source's, scaled. The default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub steering_from_trials: bool,
    /// That rate is taken over as long a time as the noise of the rudder's readings asks for, not
    /// by the ship's length alone. The default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub steering_above_noise: bool,
    /// Terms of an input that no trial records, such as the wind, are left out where the source has
    /// none. The default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub recorded_terms: bool,
    /// A source without roll takes the stiffness in roll from the ship's metacentric height, and a
    /// usual damping, where the law that is fitted rolls and says the same in the plane. Every new
    /// order has it, and the default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub hydrostatic_roll: bool,
    /// A source of another law that does not roll says sway and yaw, too, of a ship that stays
    /// upright, where the law that is fitted couples them with roll, and roll begins with
    /// hydrostatics. Every new order has it, and the default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub plane_source: bool,
    /// By how much stronger the prior of roll is than the likeliest by the trials, dimensionless.
    /// The default search sets it where a model rolls over.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_strength: Option<f64>,
    /// An estimate that stands in the source's place makes the approach speed at the revolutions that
    /// the trials record, not at those that its own propeller needs. Every new order of a `mixture`
    /// has it, and the default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub recorded_revolutions: bool,
    /// The posterior is as wide as models are apart that each missed some of the trials, where that
    /// is wider than the noise of the readings makes it. The default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub posterior_by_folds: bool,
    /// That width is taken by the normal's quantile, not by Student's: it is a mean over the
    /// figures of all standard manoeuvres. The default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub folds_pooled: bool,
    /// No more is computed than the numbers need: simulations step as far as the ship's motion
    /// allows, the weak form takes neighbouring samples in the mean, and the noise model is searched
    /// in two rounds. The default search sets it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub economical: bool,
    /// What late instruments would explain of the trials is learned from the rates that the filter
    /// expects, not from those on the recorded path, whose noise is that of the readings: a right
    /// model seems late by it. Every new order has it; docs/evidence/diagnosis_unseen.md.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub expected_rates: bool,
    /// How far readings are apart whose noise is new is asked of the trials as they were recorded,
    /// and kept with what they leave open, so that later trials are read alike. Every new order has
    /// it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub reading_interval: bool,
    /// The noise model of what the trials leave open is learned on whole trials of about so many
    /// samples in all, those that differ most. Where absent, on all. The default search sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub calibration_samples: Option<usize>,
    /// Names of trials that are kept out of fit and choice altogether, to be judged on.
    pub held_out: Vec<String>,
    /// What the refined model must keep to.
    #[serde(skip_serializing_if = "Constraints::is_empty")]
    pub constraints: Constraints,
    /// How the posterior is sampled for the bands of the standard manoeuvres; no samples leave them
    /// out.
    pub bands: Sampling,
}

impl Default for Settings {
    fn default() -> Self {
        let range = |exponent: i32| Range {
            lambda_min: 10_f64.powi(-exponent),
            lambda_max: 1e10,
            alpha_max: (0.1 * f64::from(1 + exponent)).min(1.0),
        };
        Self {
            method: Method::Published,
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
            in_parts: false,
            steering_from_trials: false,
            steering_above_noise: false,
            recorded_terms: false,
            hydrostatic_roll: false,
            plane_source: false,
            roll_strength: None,
            recorded_revolutions: false,
            posterior_by_folds: false,
            folds_pooled: false,
            economical: false,
            expected_rates: false,
            reading_interval: false,
            calibration_samples: None,
            held_out: Vec::new(),
            constraints: Constraints::default(),
            bands: Sampling::default(),
        }
    }
}

impl Settings {
    /// With what a new order means where it says nothing. Versions of before it was asked have none.
    pub fn as_ordered(mut self) -> Self {
        if self.prior == Prior::Mixture && self.mixture_positions.is_empty() {
            self.mixture_positions = MIXTURE_POSITIONS.to_vec();
        }
        self.recorded_revolutions |= self.prior == Prior::Mixture;
        self.hydrostatic_roll = true;
        self.plane_source = true;
        self.expected_rates = true;
        self.reading_interval = true;
        self
    }

    /// Fills in what model selection chooses among, so that a version records it.
    pub(super) fn fill_selection(&mut self, families: &[Family]) {
        if self.families.is_empty() {
            self.families = families.to_vec();
        }
        if self.strengths.is_empty() {
            self.strengths = (0..=18).map(|k| 10_f64.powf(1.0 - 0.5 * f64::from(k))).collect();
        }
    }

    /// What a refinement by these settings is from, for people: the source by its name, or what
    /// stands in its place; [`TRIALS_ALONE`] where there is no source.
    pub fn origin<'a>(&self, source: Option<&'a str>) -> &'a str {
        match self.prior {
            Prior::Mixture if self.mixture_positions == [ESTIMATE_POSITION] => {
                "the estimate from particulars"
            }
            Prior::Population => "a population of ships",
            Prior::Mixture | Prior::Source => source.unwrap_or(TRIALS_ALONE),
        }
    }

    /// Window in which motions are smoothed that errors on manoeuvres left out are against, s; those
    /// on trials that are kept out are against motions as recorded.
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
            let settings = Settings { prior, mixture_positions, ..Settings::default() };
            settings.origin(source).to_owned()
        };
        assert_eq!(of(Prior::Source, &[], Some("wpcc/1")), "wpcc/1");
        assert_eq!(of(Prior::Source, &[], None), TRIALS_ALONE);
        assert_eq!(of(Prior::Population, &[], Some("wpcc/1")), "a population of ships");
        assert_eq!(of(Prior::Mixture, &[0.5], Some("wpcc/1")), "wpcc/1");
        assert_eq!(of(Prior::Mixture, &[1.0], Some("wpcc/1")), "the estimate from particulars");
    }
}
