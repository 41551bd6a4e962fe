//! Learned correction of a law of motion, in the modes of Kanazawa 2023, Sec. 2.1. The document
//! names its weights by hash; `sistership-learned` stores, trains and evaluates the weights.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::learned::AttachedWeights;
use crate::validity::{RangeError, Region};

/// Learned correction of a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CorrectionDocument {
    /// Combination with the law of motion, the foundation.
    pub mode: CorrectionMode,
    /// The accelerations that it changes, each once.
    pub outputs: Vec<CorrectionOutput>,
    /// SHA-256 of the weights.
    pub weights_sha256: String,
    /// The motion that its training covered.
    pub domain: Region,
    /// Distance beyond the domain at which its share has faded to zero, in half ranges of the
    /// domain.
    pub fade: f64,
    /// Settings of its training.
    pub recipe: CorrectionRecipe,
    /// The weights, if they have been attached; not part of the document.
    #[serde(skip)]
    #[schemars(skip)]
    pub learned: AttachedWeights,
}

/// Combination of a learned correction with its foundation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CorrectionMode {
    /// It gives the accelerations, without inputs from the foundation: Eq. 2.5.
    Convert,
    /// It gives the accelerations, with those of the foundation among its inputs: Eq. 2.6.
    Serial,
    /// It gives an addition to the foundation's accelerations: Eq. 2.8.
    Parallel,
}

/// An acceleration that a learned correction changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CorrectionOutput {
    /// The axis: X, Y or N.
    pub axis: Axis,
    /// The inputs from which it is calculated, in the order of the weights.
    pub inputs: Vec<CorrectionInput>,
    /// Acceleration for an output of the weights of one, m/s2 (rad/s2).
    pub scale: f64,
    /// Least and greatest value in its training, m/s2 (rad/s2); outputs are limited to this range.
    pub range: [f64; 2],
}

/// An input of a learned correction: the weights take `(value - centre) / scale`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CorrectionInput {
    /// The signal.
    pub signal: Signal,
    /// Mean over the training, SI and radians.
    pub centre: f64,
    /// Standard deviation over the training, SI and radians.
    pub scale: f64,
}

/// Signals that may be inputs of a learned correction.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Signal {
    /// Surge velocity, m/s.
    U,
    /// Sway velocity, m/s.
    V,
    /// Yaw rate, rad/s.
    R,
    /// Rudder angle, rad.
    Delta,
    /// Propeller revolutions, 1/s.
    N,
    /// Drift angle `atan2(-v, u)`, rad.
    Beta,
    /// The foundation's surge acceleration, m/s2.
    UDot,
    /// The foundation's sway acceleration, m/s2.
    VDot,
    /// The foundation's yaw acceleration, rad/s2.
    RDot,
}

impl Signal {
    /// Returns true if the signal is an acceleration of the foundation.
    pub fn is_of_foundation(self) -> bool {
        matches!(self, Self::UDot | Self::VDot | Self::RDot)
    }
}

/// Settings of the training of a learned correction; with the foundation and the samples of the
/// trials they determine its bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CorrectionRecipe {
    /// The learning algorithm with its settings.
    pub learner: Learner,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Time over which accelerations are measured, s.
    pub window_s: f64,
    /// Interval between samples of the training, s.
    pub hop_s: f64,
    /// Names of the trials.
    pub trials: Vec<String>,
}

/// Learning algorithm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Learner {
    /// The mean of trees grown on bootstrapped samples (Breiman 2001; Mei 2019, Table 1).
    RandomForest {
        /// Number of trees.
        trees: usize,
        /// Number of inputs that are considered at each split.
        tried: usize,
        /// Fewest samples in a leaf.
        leaf: usize,
        /// Most splits from root to leaf.
        depth: usize,
    },
    /// The sum of small trees, each grown on the residual of those before it (Friedman 2002).
    BoostedTrees {
        /// Number of trees.
        trees: usize,
        /// Fewest samples in a leaf.
        leaf: usize,
        /// Most splits from root to leaf.
        depth: usize,
        /// Learning rate: the factor of each tree.
        rate: f64,
        /// Share of the samples, drawn without replacement, on which a tree grows.
        sampled: f64,
    },
    /// Ridge regression on rational quadratic kernels about some of the samples: the mean of a
    /// Gaussian process by a subset of regressors (Rasmussen and Williams 2006, Eqs. 4.19, 8.14).
    KernelRidge {
        /// Number of samples at which kernels are centred.
        centres: usize,
        /// Length scale, in standard deviations of the inputs.
        length: f64,
        /// Variance of the noise relative to that of the process.
        ridge: f64,
    },
    /// A multilayer perceptron, trained by Adam (Kingma and Ba 2015) on squared errors.
    Perceptron {
        /// Neurons of each hidden layer.
        hidden: Vec<usize>,
        /// Number of passes over the samples.
        epochs: usize,
        /// Samples in each step.
        batch: usize,
        /// Initial step size; it falls linearly to zero.
        rate: f64,
        /// Decay of the weights.
        decay: f64,
    },
}

impl Learner {
    /// Name of the algorithm.
    pub fn name(&self) -> &'static str {
        match self {
            Self::RandomForest { .. } => "random forest",
            Self::BoostedTrees { .. } => "boosted trees",
            Self::KernelRidge { .. } => "kernel ridge",
            Self::Perceptron { .. } => "perceptron",
        }
    }
}

impl CorrectionMode {
    /// Every mode.
    pub const ALL: [Self; 3] = [Self::Convert, Self::Serial, Self::Parallel];

    /// Name of the mode.
    pub fn name(self) -> &'static str {
        match self {
            Self::Convert => "convert",
            Self::Serial => "serial",
            Self::Parallel => "parallel",
        }
    }
}

impl CorrectionDocument {
    /// Description in words: `random forest, parallel`.
    pub fn describe(&self) -> String {
        format!("{}, {}", self.recipe.learner.name(), self.mode.name())
    }
}

/// Reason for which a learned correction cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CorrectionError {
    /// The outputs are not one to three different axes among X, Y and N.
    #[error("outputs: give at least one of the axes X, Y and N, and each at most once")]
    Outputs,
    /// An input is not permitted.
    #[error("outputs.{axis}.inputs: {reason}")]
    Input {
        /// The output's axis.
        axis: Axis,
        /// Description of the error.
        reason: &'static str,
    },
    /// A scale or range is not valid.
    #[error("outputs.{0}: scale should be above 0, and range two increasing numbers")]
    Scale(Axis),
    /// The hash is not one of SHA-256.
    #[error("weights_sha256: should be 64 hexadecimal digits")]
    Hash,
    /// The fade distance is not valid.
    #[error("fade: {0} should be above 0 and at most {MAX_FADE}")]
    Fade(f64),
    /// The domain lacks ranges of velocities.
    #[error("domain: should have ranges of u, v and r")]
    Domain,
    /// The bounds of the domain are not in order.
    #[error("domain.{0}")]
    Range(#[from] RangeError),
    /// A setting of the training is out of range.
    #[error("recipe.{field}: {reason}")]
    Recipe {
        /// The setting.
        field: &'static str,
        /// The permitted range.
        reason: &'static str,
    },
}

/// Largest fade distance, in half ranges; `sistership-learned` also requires that the faded region
/// lies within the physical range of simulations.
pub const MAX_FADE: f64 = 3.0;

impl CorrectionDocument {
    /// Checks that the parts of the document are consistent.
    ///
    /// # Errors
    /// Returns an error that names the field at fault.
    pub fn check_document(&self) -> Result<(), CorrectionError> {
        let axes = [Axis::X, Axis::Y, Axis::N];
        let of = |axis: Axis| self.outputs.iter().filter(|output| output.axis == axis).count();
        let known: usize = axes.iter().map(|axis| of(*axis)).sum();
        if self.outputs.is_empty()
            || known != self.outputs.len()
            || axes.iter().any(|axis| of(*axis) > 1)
        {
            return Err(CorrectionError::Outputs);
        }
        self.outputs.iter().try_for_each(|output| output.check_output(self.mode))?;
        let is_hex = self.weights_sha256.bytes().all(|byte| byte.is_ascii_hexdigit());
        if self.weights_sha256.len() != 64 || !is_hex {
            return Err(CorrectionError::Hash);
        }
        if !(self.fade > 0.0 && self.fade <= MAX_FADE) {
            return Err(CorrectionError::Fade(self.fade));
        }
        if ["u", "v", "r"].iter().any(|name| !self.domain.ranges.contains_key(*name)) {
            return Err(CorrectionError::Domain);
        }
        self.domain.check_bounds()?;
        self.recipe.check_settings()
    }
}

impl CorrectionOutput {
    fn check_output(&self, mode: CorrectionMode) -> Result<(), CorrectionError> {
        let refuse = |reason| Err(CorrectionError::Input { axis: self.axis, reason });
        if self.inputs.is_empty() {
            return refuse("give one at least");
        }
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if self.inputs.iter().any(|input| !input.centre.is_finite() || !positive(input.scale)) {
            return refuse("centre should be a number and scale above 0");
        }
        // Accelerations of the foundation are inputs of the serial mode by definition (Eq. 2.6).
        let of_foundation = |input: &CorrectionInput| input.signal.is_of_foundation();
        if mode == CorrectionMode::Convert && self.inputs.iter().any(of_foundation) {
            return refuse("in mode `convert` no input may be an acceleration of the foundation");
        }
        if mode == CorrectionMode::Serial && !self.inputs.iter().any(of_foundation) {
            return refuse(
                "in mode `serial` one input should be an acceleration of the foundation",
            );
        }
        let [low, high] = self.range;
        if !(positive(self.scale) && low.is_finite() && high.is_finite() && low <= high) {
            return Err(CorrectionError::Scale(self.axis));
        }
        Ok(())
    }
}

impl CorrectionRecipe {
    /// Checks the settings.
    ///
    /// # Errors
    /// Returns an error that names the first setting that is out of range.
    pub fn check_settings(&self) -> Result<(), CorrectionError> {
        let refuse = |field, reason| Err(CorrectionError::Recipe { field, reason });
        if !(self.window_s > 0.0 && self.window_s.is_finite()) {
            return refuse("window_s", "should be above 0 s");
        }
        if !(self.hop_s > 0.0 && self.hop_s.is_finite()) {
            return refuse("hop_s", "should be above 0 s");
        }
        self.learner.first_invalid_setting().map_or(Ok(()), |(field, reason)| refuse(field, reason))
    }
}

/// Check of one setting of a learner.
struct SettingCheck {
    holds: bool,
    field: &'static str,
    /// The permitted range.
    range: &'static str,
}

impl SettingCheck {
    fn new(holds: bool, field: &'static str, range: &'static str) -> Self {
        Self { holds, field, range }
    }

    fn tree_count(trees: usize) -> Self {
        Self::new((1..=1000).contains(&trees), "learner.trees", "should be from 1 to 1000")
    }

    fn leaf_size(leaf: usize) -> Self {
        Self::new((1..=1 << 20).contains(&leaf), "learner.leaf", "should be from 1 to 1048576")
    }

    fn tree_depth(depth: usize) -> Self {
        Self::new((1..=30).contains(&depth), "learner.depth", "should be from 1 to 30")
    }

    /// A number above 0, at most 1.
    fn unit_share(value: f64, field: &'static str) -> Self {
        Self::new(value > 0.0 && value <= 1.0, field, "should be above 0 and at most 1")
    }

    fn positive_number(value: f64, field: &'static str) -> Self {
        Self::new(value > 0.0 && value.is_finite(), field, "should be a finite number above 0")
    }
}

impl Learner {
    /// Returns the first setting that is out of range, with the permitted range.
    fn first_invalid_setting(&self) -> Option<(&'static str, &'static str)> {
        let invalid = self.setting_checks().into_iter().find(|check| !check.holds)?;
        Some((invalid.field, invalid.range))
    }

    /// Checks of all settings, each under its own field.
    fn setting_checks(&self) -> Vec<SettingCheck> {
        match self {
            Self::RandomForest { trees, tried, leaf, depth } => vec![
                SettingCheck::tree_count(*trees),
                SettingCheck::leaf_size(*leaf),
                SettingCheck::tree_depth(*depth),
                SettingCheck::new(
                    (1..=16).contains(tried),
                    "learner.tried",
                    "should be from 1 to 16",
                ),
            ],
            Self::BoostedTrees { trees, leaf, depth, rate, sampled } => vec![
                SettingCheck::tree_count(*trees),
                SettingCheck::leaf_size(*leaf),
                SettingCheck::tree_depth(*depth),
                SettingCheck::unit_share(*rate, "learner.rate"),
                SettingCheck::unit_share(*sampled, "learner.sampled"),
            ],
            Self::KernelRidge { centres, length, ridge } => vec![
                SettingCheck::new(
                    (1..=2000).contains(centres),
                    "learner.centres",
                    "should be from 1 to 2000",
                ),
                SettingCheck::positive_number(*length, "learner.length"),
                SettingCheck::positive_number(*ridge, "learner.ridge"),
            ],
            Self::Perceptron { hidden, epochs, batch, rate, decay } => vec![
                SettingCheck::new(
                    (1..=4).contains(&hidden.len())
                        && hidden.iter().all(|width| (1..=256).contains(width)),
                    "learner.hidden",
                    "give one to four layers of 1 to 256 neurons",
                ),
                SettingCheck::new(
                    (1..=10_000).contains(epochs),
                    "learner.epochs",
                    "should be from 1 to 10000",
                ),
                SettingCheck::new(
                    (1..=1 << 16).contains(batch),
                    "learner.batch",
                    "should be from 1 to 65536",
                ),
                SettingCheck::unit_share(*rate, "learner.rate"),
                SettingCheck::new(
                    (0.0..=1.0).contains(decay),
                    "learner.decay",
                    "should be from 0 to 1",
                ),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn invalid_field(learner: &Learner) -> Option<&'static str> {
        learner.first_invalid_setting().map(|(field, _)| field)
    }

    #[test]
    fn a_setting_out_of_range_is_reported_under_its_own_field() {
        let boosted = |rate: f64, sampled: f64| Learner::BoostedTrees {
            trees: 10,
            leaf: 5,
            depth: 3,
            rate,
            sampled,
        };
        assert_eq!(invalid_field(&boosted(0.05, 0.5)), None);
        assert_eq!(invalid_field(&boosted(0.05, 1.5)), Some("learner.sampled"));
        assert_eq!(invalid_field(&boosted(f64::NAN, 0.5)), Some("learner.rate"));
        let perceptron = |rate: f64, decay: f64| Learner::Perceptron {
            hidden: vec![8],
            epochs: 10,
            batch: 16,
            rate,
            decay,
        };
        assert_eq!(invalid_field(&perceptron(0.01, 0.0)), None);
        assert_eq!(invalid_field(&perceptron(0.01, -0.1)), Some("learner.decay"));
        assert_eq!(invalid_field(&perceptron(0.0, 0.0)), Some("learner.rate"));
    }

    #[test]
    fn the_range_has_both_ends() {
        let forest = Learner::RandomForest { trees: 10, tried: 2, leaf: (1 << 20) + 1, depth: 3 };
        let range = forest.first_invalid_setting();
        assert_eq!(range, Some(("learner.leaf", "should be from 1 to 1048576")));
    }
}
